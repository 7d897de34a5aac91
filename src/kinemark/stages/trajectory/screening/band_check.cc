// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/band_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

namespace kinemark::trajectory {
namespace {

using data::BandVerdict;

constexpr std::int64_t kWindow = 128;
constexpr std::int64_t kLeastFrames = 64;
constexpr std::int64_t kMostFrames = 4096;

/// First frame and length of the longest complete stretch.
std::pair<std::int64_t, std::int64_t> longest_stretch(const data::Trajectories& t, std::int64_t marker) {
  std::pair<std::int64_t, std::int64_t> best{0, 0};
  std::int64_t start = 0;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (!t.present(f, marker)) start = f + 1;
    if (f + 1 - start > best.second) best = {start, f + 1 - start};
  }
  return best;
}

/// Straight line out, Hann window in.
void prepare(std::vector<double>& y) {
  const auto n = static_cast<double>(y.size());
  double mean = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double at = static_cast<double>(i) - 0.5 * (n - 1.0);
    mean += y[i] / n;
    moment += y[i] * at;
  }
  const double slope = moment / (n * (n * n - 1.0) / 12.0);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double at = static_cast<double>(i) - 0.5 * (n - 1.0);
    const double hann = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / n);
    y[i] = (y[i] - mean - slope * at) * hann;
  }
}

/// Add |DFT|^2 of y to power, bins 0 to n / 2.
void add_power(const std::vector<double>& y, const std::vector<double>& cosine, std::vector<double>& power) {
  const std::size_t n = y.size();
  const std::size_t quarter_back = n - n / 4;  // sin(x) = cos(x - pi / 2); n is a multiple of 4
  for (std::size_t k = 0; k < power.size(); ++k) {
    double re = 0.0;
    double im = 0.0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
      re += y[i] * cosine[at];
      im += y[i] * cosine[(at + quarter_back) % n];
      at = (at + k) % n;
    }
    power[k] += re * re + im * im;
  }
}

double median_of(std::span<const double> values, std::size_t first, std::size_t last) {
  return math::median(values.subspan(first, last - first));
}

}  // namespace

data::BandCheck check_band(const data::Trajectories& t, std::int64_t marker) {
  check(marker >= 0 && marker < t.markers(), "check_band() needs a marker of the trajectories");
  data::BandCheck band;
  const auto [start, longest] = longest_stretch(t, marker);
  const std::int64_t frames = std::min(longest, kMostFrames);
  if (frames < kLeastFrames) return band;
  const std::int64_t n = std::min(kWindow, frames / 4 * 4);
  std::vector<double> cosine(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < cosine.size(); ++i)
    cosine[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
  std::vector<double> power(static_cast<std::size_t>(n / 2 + 1), 0.0);
  double step = 0.0;
  std::int64_t windows = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> y(static_cast<std::size_t>(frames));
    for (std::int64_t i = 0; i < frames; ++i) y[static_cast<std::size_t>(i)] = t.x(start + i, marker)(axis);
    step = std::max(step, internal::rounding_step_m(y));
    for (std::int64_t at = 0; at + n <= frames; at += n / 2, ++windows) {
      std::vector<double> part(y.begin() + at, y.begin() + at + n);
      prepare(part);
      add_power(part, cosine, power);
    }
  }
  // White noise of variance s^2 has a mean |DFT|^2 of s^2 times the sum of squared weights, 3 n / 8 for Hann.
  for (double& p : power) p /= static_cast<double>(windows) * 0.375 * static_cast<double>(n);
  const std::size_t bins = power.size();
  if (!std::ranges::all_of(power, [](double p) { return std::isfinite(p); }))
    return band;  // numbers too large
  const double top = median_of(power, bins * 8 / 10, bins - 1);
  band.top_m = std::sqrt(top);
  band.middle_m = std::sqrt(median_of(power, bins * 3 / 10, bins * 6 / 10));
  std::size_t edge = bins;
  while (edge > 0 && !(power[edge - 1] > 10.0 * top)) --edge;
  band.edge_hz = 0.5 * t.time.rate_hz * static_cast<double>(edge) / static_cast<double>(bins);
  const bool falls = band.top_m <= 0.2 * band.middle_m;
  const bool only_rounding = band.top_m <= 1.5 * step / std::sqrt(12.0);
  band.verdict = (falls || only_rounding) && band.top_m < 1e-5 ? BandVerdict::low_passed
                 : band.top_m < 0.5 * band.middle_m            ? BandVerdict::undecided
                                                               : BandVerdict::open;
  return band;
}

}  // namespace kinemark::trajectory
