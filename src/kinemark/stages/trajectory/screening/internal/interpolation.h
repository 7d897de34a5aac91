// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinemark/stages/trajectory/screening/upsampling.h"

namespace kinemark::trajectory::internal {

inline constexpr std::array kKernels{Kernel::hold,     Kernel::linear, Kernel::spline, Kernel::catmull_rom,
                                     Kernel::lagrange, Kernel::pchip,  Kernel::akima};

/// Knots not used at both ends of a stretch: the end condition of a spline is unknown and its effect decays
/// by 0.27 per knot; the others depend on two neighbours.
[[nodiscard]] constexpr int edge_knots(Kernel kernel) { return kernel == Kernel::spline ? 8 : 2; }
/// Fewest frames of a stretch that is tested.
[[nodiscard]] constexpr int min_stretch(int factor, Kernel kernel) {
  return factor * (kernel == Kernel::spline ? 24 : 12);
}

/// Memory that residuals() reuses.
struct Knots {
  std::vector<double> value, slope, scratch;
};

/// Suppose that samples phase, phase + factor, ... are real: predict those in between and write y minus
/// prediction; `kNotPredicted` at knots and where knots are too few. False when nothing is predicted. O(n).
bool residuals(std::span<const double> y, int factor, int phase, Kernel kernel, Knots& knots,
               std::span<double> out);
inline constexpr double kNotPredicted = 1e300;

}  // namespace kinemark::trajectory::internal
