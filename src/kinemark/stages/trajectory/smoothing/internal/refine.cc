// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/refine.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kRefineWider = 1.6, kRefineLowest = 0.7,
                 kRefineHighest = 1.2;  ///< of the cut-off for positions
constexpr int kTried = 9;
constexpr double kRefineInterior =
    1.2;  ///< variance of velocity up to this times the least: samples all around

struct Velocities {
  std::vector<double> state, variance;
  Velocities(const Series& part, int order, double cutoff_hz)
      : state(static_cast<std::size_t>(part.frames * part.axes * 4)),
        variance(static_cast<std::size_t>(part.frames * 4)) {
    smooth_series(part, order, cutoff_hz, {state.data(), variance.data()});
  }
};

/// sigma^2 dt / pi times the integral of w^2 H H_wide for sigma = 1: velocity noise that both filters share.
double shared_noise(int order, double cutoff_hz, double wide_hz, double interval_s) {
  const double corner = corner_rad_s(order, cutoff_hz), wide = corner_rad_s(order, wide_hz);
  const double top = std::min(M_PI / interval_s, 6.0 * wide);
  constexpr int kSteps = 1000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = top * (i + 0.5) / kSteps;
    sum += w * w / (1.0 + std::pow(w / corner, 2 * order)) / (1.0 + std::pow(w / wide, 2 * order));
  }
  return interval_s / M_PI * sum * top / kSteps;
}

}  // namespace

double refine_cutoff(std::span<const Series> parts, int order, double cutoff_hz, double noise_sd_m) {
  const double wide_hz = kRefineWider * cutoff_hz;
  std::vector<Velocities> base, wide;
  double least_variance = std::numeric_limits<double>::infinity();
  for (const Series& part : parts) {
    base.emplace_back(part, order, cutoff_hz);
    wide.emplace_back(part, order, wide_hz);
    const auto& variance = base.back().variance;
    for (std::size_t i = 1; i < variance.size(); i += 4)
      if (variance[i] < least_variance) least_variance = variance[i];
  }
  double best = cutoff_hz, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTried; ++i) {
    const double tried =
        cutoff_hz * kRefineLowest * std::pow(kRefineHighest / kRefineLowest, i / (kTried - 1.0));
    double sum = 0.0, count = 0.0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Series& part = parts[p];
      const Velocities now(part, order, tried);
      for (std::int64_t k = 0; k < part.frames; ++k) {
        if (!(base[p].variance[static_cast<std::size_t>(4 * k + 1)] <= kRefineInterior * least_variance))
          continue;
        for (int axis = 0; axis < part.axes; ++axis) {
          const auto at = static_cast<std::size_t>((k * part.axes + axis) * 4 + 1);
          const double difference = wide[p].state[at] - now.state[at];
          if (std::isnan(difference)) continue;
          sum += difference * difference;
          count += 1.0;
        }
      }
    }
    if (count == 0.0) return cutoff_hz;
    const double risk = sum / count + 2.0 * noise_sd_m * noise_sd_m *
                                          shared_noise(order, tried, wide_hz, parts.front().interval_s);
    if (risk >= least) continue;
    least = risk;
    best = tried;
  }
  return std::sqrt(best * cutoff_hz);
}

}  // namespace kinemark::trajectory::smoothing
