// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/local_bias.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kSurely = 21.1;  // chi-square of three degrees of freedom, p = 1e-4

/// Square of the mean residual over `half` frames on either side, less that of noise, per axis; 0 where noise
/// explains it.
Eigen::Array3d bias_square(const MarkerSamples& samples, const MarkerResult& result, std::int64_t frame,
                           std::int64_t half) {
  const double noise = result.account.used.noise_sd_m;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  Eigen::Array3d variance = Eigen::Array3d::Zero();
  double n = 0.0;
  for (std::int64_t f = frame - half; f <= frame + half; ++f) {
    if (f < 0 || f >= samples.frames || samples.judged[at(f)] == 0 || std::isnan(result.x[at(3 * f)]))
      continue;
    n += 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double own = samples.variance.empty() ? 1.0 : samples.variance[at(axis * samples.frames + f)];
      sum[axis] += samples.x[at(3 * f + axis)] - result.x[at(3 * f + axis)];
      variance[axis] += noise * noise * own;
    }
  }
  if (n <= static_cast<double>(half) || !((sum.square() / variance).sum() > kSurely))
    return Eigen::Array3d::Zero();
  return ((sum.square() - variance) / (n * n)).max(0.0);
}

}  // namespace

void add_local_bias(const MarkerSamples& samples, MarkerResult& result) {
  const data::FilterUsed& used = result.account.used;
  if (result.covariance.empty() || !(used.noise_sd_m > 0.0) || !(used.cutoff_hz > 0.0)) return;
  const double quarter = 0.25 / (used.cutoff_hz * samples.interval_s);
  const auto reach = static_cast<std::int64_t>(std::lround(quarter));
  const auto half = static_cast<std::int64_t>(std::lround(0.5 * quarter));
  std::vector<Eigen::Array3d> extra(at(samples.frames), Eigen::Array3d::Zero());
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    Eigen::Array3d square = Eigen::Array3d::Zero();
    for (std::int64_t h = 0; h <= half; ++h) square = square.max(bias_square(samples, result, f, h));
    if (!(square.maxCoeff() > 0.0)) continue;
    for (std::int64_t k = std::max<std::int64_t>(0, f - reach); k < std::min(samples.frames, f + reach + 1);
         ++k)
      extra[at(k)] = extra[at(k)].max(square);
  }
  const double per_order = std::pow(2.0 * M_PI * used.cutoff_hz, 2);
  for (std::int64_t f = 0; f < samples.frames; ++f)
    for (int axis = 0; axis < 3; ++axis) {
      double variance = extra[at(f)][axis];
      if (!(variance > 0.0)) continue;
      result.covariance[at(6 * f) + math::kSymmetric3Diagonal[at(axis)]] += variance;
      for (Array<double>* sd : {&result.velocity_sd, &result.acceleration_sd, &result.jerk_sd}) {
        variance *= per_order;
        if (!sd->empty()) (*sd)[at(3 * f + axis)] = std::hypot((*sd)[at(3 * f + axis)], std::sqrt(variance));
      }
    }
}

}  // namespace kinemark::trajectory::smoothing
