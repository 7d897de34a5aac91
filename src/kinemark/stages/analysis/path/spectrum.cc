// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "kinemark/core/check.h"

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kLong = 8192;       // samples from which a series is thinned out first
constexpr double kAttenuation_db = 200.0;  // of what would be taken for lower frequencies

// A low-pass of unit gain at 0 by Kaiser's window: weights -half .. half of the samples about one. Both bands
// are even within the attenuation.
// @param pass, stop  ends of the bands, cycles per sample
std::vector<double> low_pass(double pass, double stop) {
  const double width = 2.0 * std::numbers::pi * (stop - pass), middle = 0.5 * (pass + stop);
  const auto half = static_cast<std::int64_t>(std::ceil(0.5 * (kAttenuation_db - 8.0) / (2.285 * width)));
  const double beta = 0.1102 * (kAttenuation_db - 8.7);
  std::vector<double> out;
  for (std::int64_t k = -half; k <= half; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(half);
    const double angle = 2.0 * std::numbers::pi * middle * static_cast<double>(k);
    const double sinc = k == 0 ? 1.0 : std::sin(angle) / angle;
    out.push_back(2.0 * middle * sinc * std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - share * share)) /
                  std::cyl_bessel_i(0.0, beta));
  }
  return out;
}

// Every `step`-th sample of the low-passed series, from where its first sample is first felt.
Eigen::VectorXd thinned(const Eigen::VectorXd& series, std::int64_t step,
                        const std::vector<double>& weights) {
  const auto half = static_cast<std::int64_t>(weights.size() / 2);
  const std::int64_t n = series.size(), lead = (half + step - 1) / step;
  Eigen::VectorXd out(lead + (n - 1 + half) / step + 1);
  for (std::int64_t q = 0; q < out.size(); ++q) {
    const std::int64_t middle = (q - lead) * step;
    const std::int64_t first = std::max<std::int64_t>(0, middle - half),
                       last = std::min(n - 1, middle + half);
    double sum = 0.0;
    for (std::int64_t i = first; i <= last; ++i)
      sum += weights[static_cast<std::size_t>(i - middle + half)] * series[i];
    out[q] = sum;
  }
  return out;
}

}  // namespace

Eigen::VectorXd amplitudes(const Eigen::VectorXd& series, std::int64_t length) {
  check(length >= series.size() && length > 0, "a transform is as long as its series, or longer");
  std::vector<double> padded(static_cast<std::size_t>(length), 0.0);
  for (Eigen::Index i = 0; i < series.size(); ++i) padded[static_cast<std::size_t>(i)] = series[i];
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  Eigen::VectorXd out(length / 2 + 1);
  for (Eigen::Index k = 0; k < out.size(); ++k)
    out[k] = std::sqrt(std::norm(spectrum[static_cast<std::size_t>(k)]));
  return out;
}

Eigen::VectorXd low_amplitudes(const Eigen::VectorXd& series, std::int64_t length, std::int64_t highest) {
  check(highest >= 0 && highest <= length / 2, "a transform has frequencies up to half a cycle per sample");
  const double pass = static_cast<double>(highest) / static_cast<double>(length);
  std::int64_t step = 1;
  while (3.0 * pass * static_cast<double>(2 * step) <= 1.0 && step < 64) step *= 2;
  if (series.size() < kLong || step == 1) return amplitudes(series, length).head(highest + 1);
  const auto few = thinned(series, step, low_pass(pass, 1.0 / static_cast<double>(step) - pass));
  return static_cast<double>(step) * amplitudes(few, length / step).head(highest + 1);
}

}  // namespace kinemark::analysis
