// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kinemark/stages/trajectory/screening/upsampling.h"

namespace kinemark::trajectory::internal {

inline constexpr std::array kKernels{
    data::InterpolationKernel::hold,     data::InterpolationKernel::linear,
    data::InterpolationKernel::spline,   data::InterpolationKernel::catmull_rom,
    data::InterpolationKernel::lagrange, data::InterpolationKernel::pchip,
    data::InterpolationKernel::akima};

/// Knots not used at both ends of a stretch: the end condition of a spline is unknown and its effect decays
/// by 0.27 per knot; the others depend on two neighbours.
[[nodiscard]] constexpr int edge_knots(data::InterpolationKernel kernel) {
  return kernel == data::InterpolationKernel::spline ? 8 : 2;
}
/// Fewest frames of a stretch that is tested.
[[nodiscard]] constexpr int min_stretch(int factor, data::InterpolationKernel kernel) {
  return factor * (kernel == data::InterpolationKernel::spline ? 24 : 12);
}

/// Memory that residuals() reuses.
struct Knots {
  std::vector<double> value, slope, scratch;
};

/// Suppose that samples phase, phase + factor, ... are real: predict those in between and write y minus
/// prediction; `kNotPredicted` at knots and where knots are too few. False when nothing is predicted. O(n).
bool residuals(std::span<const double> y, int factor, int phase, data::InterpolationKernel kernel,
               Knots& knots, std::span<double> out);
inline constexpr double kNotPredicted = 1e300;

}  // namespace kinemark::trajectory::internal
