// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/smoothness.h"

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/path/spectrum.h"

namespace kinemark::analysis {
namespace {

constexpr int kPadding = 4;           // powers of two
constexpr double kHighest_hz = 10.0;  // frequencies above do not count
constexpr double kThreshold = 0.05;   // of the largest amplitude

}  // namespace

SpectralArc spectral_arc(const Eigen::VectorXd& speed, double rate_hz) {
  SpectralArc out;
  const std::int64_t n = speed.size();
  if (n < 2 || !(speed.maxCoeff() > 0.0)) return out;
  std::int64_t power = 1;
  while (power < n) power *= 2;
  const std::int64_t length = power << kPadding;
  const auto highest = std::min<std::int64_t>(
      length / 2,
      static_cast<std::int64_t>(std::floor(kHighest_hz * static_cast<double>(length) / rate_hz + 1e-9)));
  // Speeds are not negative, so that none of the amplitudes is above that of 0 Hz.
  const Eigen::VectorXd spectrum = low_amplitudes(speed, length, highest);
  const double scale = 1.0 / spectrum.maxCoeff();
  std::int64_t first = -1, last = -1;
  for (std::int64_t k = 0; k <= highest; ++k)
    if (spectrum[k] * scale >= kThreshold) {
      if (first < 0) first = k;
      last = k;
    }
  if (last <= first) return out;
  const double step = 1.0 / static_cast<double>(last - first);
  double length_of_arc = 0.0;
  for (std::int64_t k = first + 1; k <= last; ++k) {
    const double rise = (spectrum[k] - spectrum[k - 1]) * scale;
    length_of_arc += std::sqrt(step * step + rise * rise);
  }
  out.value = -length_of_arc;
  out.last_hz = static_cast<double>(last) * rate_hz / static_cast<double>(length);
  return out;
}

double log_dimensionless_jerk(const PathSamples& path) {
  const std::int64_t n = path.count();
  if (n < 2) return kNaN;
  const Eigen::VectorXd jerk = path.j.rowwise().squaredNorm();
  const double integral = (jerk.sum() - 0.5 * (jerk[0] + jerk[n - 1])) / path.rate_hz;
  const double duration = static_cast<double>(n - 1) / path.rate_hz;
  const double peak = path.v.rowwise().squaredNorm().maxCoeff();
  return peak > 0.0 && integral > 0.0 ? -std::log(std::pow(duration, 3) / peak * integral) : kNaN;
}

double log_dimensionless_jerk_of_speed(const Eigen::VectorXd& speed, double rate_hz) {
  const std::int64_t n = speed.size();
  if (n < 3) return kNaN;
  const Eigen::VectorXd second_difference =
      (speed.tail(n - 2) - 2.0 * speed.segment(1, n - 2) + speed.head(n - 2)) * (rate_hz * rate_hz);
  const double integral = second_difference.squaredNorm() / rate_hz;
  const double duration = static_cast<double>(n) / rate_hz;
  const double peak = speed.cwiseAbs().maxCoeff();
  return peak > 0.0 && integral > 0.0 ? -std::log(std::pow(duration, 3) / (peak * peak) * integral) : kNaN;
}

double rms_jerk(const PathSamples& path) { return std::sqrt(path.j.rowwise().squaredNorm().mean()); }

}  // namespace kinemark::analysis
