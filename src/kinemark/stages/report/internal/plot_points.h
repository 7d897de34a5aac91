// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinemark::report::internal {

/// How F frames become the points of a plot: point i stands for frames [i * step, (i + 1) * step).
///
/// step is 1 when the frames fit. Otherwise points come in pairs, and each pair holds the smallest and the
/// largest value of its 2 * step frames in the order in which they occurred, so that no peak is lost.
class PlotPoints {
 public:
  /// The finest grid with at most max_points (>= 2) points.
  PlotPoints(std::int64_t frames, std::int64_t max_points);

  [[nodiscard]] std::int64_t step() const { return step_; }
  [[nodiscard]] std::int64_t size() const { return size_; }

  /// Values on the grid; NaN only where all frames of a pair are NaN.
  [[nodiscard]] std::vector<float> extremes(std::span<const double> values) const;
  /// The largest value of each pair, for both of its points; error bars are never understated.
  [[nodiscard]] std::vector<float> largest(std::span<const double> values) const;
  /// The largest code among the frames of each point.
  [[nodiscard]] std::vector<std::uint8_t> worst(std::span<const std::uint8_t> codes) const;

  /// Of curves that are points already: as their own, or thinned further. Pairs of pairs are pairs.
  [[nodiscard]] std::vector<float> extremes(std::span<const float> values) const;
  [[nodiscard]] std::vector<float> largest(std::span<const float> values) const;  ///< likewise

 private:
  std::int64_t frames_;
  std::int64_t step_ = 1;
  std::int64_t size_;
};

}  // namespace kinemark::report::internal
