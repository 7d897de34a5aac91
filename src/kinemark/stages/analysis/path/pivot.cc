// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/pivot.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kinemark::analysis {
namespace {

// The value at rank (S + 1) p, counted from 1, by a straight line between its neighbours.
double quantile_of(const std::vector<double>& sorted, double p) {
  const double size = static_cast<double>(sorted.size());
  const double rank = std::clamp((size + 1.0) * p, 1.0, size) - 1.0;
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (rank - std::floor(rank)) * (sorted[above] - sorted[below]);
}

}  // namespace

Pivoted pivot(double estimate, std::span<const double> deviations, double level) {
  Pivoted out;
  std::vector<double> sorted;
  for (const double d : deviations)
    if (std::isfinite(d)) sorted.push_back(d);
  if (sorted.size() < 2 || 10 * (deviations.size() - sorted.size()) > deviations.size()) return out;
  std::ranges::sort(sorted);
  double mean = 0.0, squares = 0.0;
  const double size = static_cast<double>(sorted.size());
  for (const double d : sorted) mean += d / size;
  for (const double d : sorted) squares += (d - mean) * (d - mean);
  const double tail = 0.5 * (1.0 - level);
  out.value = estimate - mean;
  out.sd = std::sqrt(squares / (size - 1.0));
  out.low = estimate - quantile_of(sorted, 1.0 - tail);
  out.high = estimate - quantile_of(sorted, tail);
  return out;
}

namespace {

Pivoted as_root(Pivoted out) {
  // No square is below 0. One that comes out there is 0, and its upper end keeps its distance from it: what
  // refits spread by is what the noise can hide.
  out.high += std::max(0.0, -out.value);
  const auto root = [](double square) {
    return std::isnan(square) ? kNaN : std::sqrt(std::max(0.0, square));
  };
  out.value = root(out.value);
  out.low = root(out.low);
  out.high = root(out.high);
  out.sd = out.value > 0.0 ? 0.5 * out.sd / out.value : kNaN;
  return out;
}

}  // namespace

Pivoted pivot_of_square(double estimate, std::span<const double> deviations, double level) {
  return as_root(pivot(estimate * estimate, deviations, level));
}

Pivoted wide_pivot(double estimate, std::span<const double> deviations, double level) {
  Pivoted out = pivot(estimate, deviations, level);
  const double below = out.high - estimate, above = out.low - estimate;  // the quantiles with the other sign
  out.low = std::min(out.low, estimate - below);
  out.high = std::max(out.high, estimate - above);
  return out;
}

Pivoted wide_pivot_of_square(double estimate, std::span<const double> deviations, double level) {
  return as_root(wide_pivot(estimate * estimate, deviations, level));
}

}  // namespace kinemark::analysis
