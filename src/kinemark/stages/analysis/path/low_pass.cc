// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/low_pass.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/normals.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

constexpr std::uint64_t kFloorStream = 1ULL << 61;
constexpr double kHighestDesign = 0.45;  // cycles per sample
constexpr double kPaddingPeriods = 3.0;  // of the cut-off, at both ends

}  // namespace

LowPassFilter::LowPassFilter(const math::NoiseModel& model, std::int64_t samples) {
  check(model.order > 0, "a low-pass has an order");
  if (model.form == math::LowPass::spline && samples > 2 * model.order) {
    spline_.emplace(std::vector<bool>(at(samples), true), model.order);
    if (spline_->factor(std::min(model.half, kHighestDesign))) return;
    spline_.reset();  // far below the sampling rate: Butterworth's is the same there
  }
  const double half = std::min(model.half, kHighestDesign);
  sections_ = math::butterworth_lowpass(model.order, half);
  padding_ = static_cast<int>(std::min(static_cast<double>(samples - 1), std::ceil(kPaddingPeriods / half)));
}

void LowPassFilter::apply(SeriesMatrix& series) const {
  if (spline_) {
    spline_->smooth(series);
    return;
  }
  std::vector<double> column(at(series.rows()));
  for (Eigen::Index k = 0; k < series.cols(); ++k) {
    for (Eigen::Index i = 0; i < series.rows(); ++i) column[at(i)] = series(i, k);
    math::filter_both_ways(sections_, padding_, column);
    for (Eigen::Index i = 0; i < series.rows(); ++i) series(i, k) = column[at(i)];
  }
}

SeriesMatrix noise_before_filter(const math::NoiseModel& model, std::int64_t samples, std::int64_t axes,
                                 std::uint64_t seed, std::uint64_t stream) {
  SeriesMatrix out(samples, axes);
  math::fill_normals(seed, stream, 0, {out.data(), at(out.size())});
  const double sd = std::sqrt(model.variance), rho = model.correlation;
  if (rho == 0.0) return sd * out;
  const double fresh = sd * std::sqrt(1.0 - rho * rho);
  out.row(0) *= sd;
  for (std::int64_t i = 1; i < samples; ++i) out.row(i) = rho * out.row(i - 1) + fresh * out.row(i);
  return out;
}

void add_floor(const math::NoiseModel& model, SeriesMatrix& to, std::int64_t column, std::int64_t axes,
               std::uint64_t seed, std::uint64_t stream) {
  if (!(model.floor > 0.0)) return;
  SeriesMatrix white(to.rows(), axes);
  math::fill_normals(seed, stream ^ kFloorStream, 0, {white.data(), at(white.size())});
  to.middleCols(column, axes) += std::sqrt(model.floor) * white;
}

}  // namespace kinemark::analysis
