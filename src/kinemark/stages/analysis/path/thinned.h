// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Extremes without the bias of choosing the largest of noisy values.
#pragma once

#include <Eigen/Core>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {

/// Extremes whose place is taken from the path with a copy of its noise added, and whose value from the path
/// with that copy taken off: the noise of both is independent where the copy is distributed as the noise is,
/// so that the largest is not the luckiest (coupled bootstrap: Oliveira, Lei & Tibshirani 2021; data fission:
/// Leiner et al. 2023).
struct ThinnedExtremes {
  Eigen::Vector3d extents = Eigen::Vector3d::Zero();  ///< along the principal axes, m
  double largest_distance = 0.0;                      ///< between two samples, m; as of Diameters
};

/// @param x      n x 3, smoothed, m
/// @param axes   of x
/// @param noise  n x 3, another draw of the noise that is left in x, m
[[nodiscard]] ThinnedExtremes thinned_extremes(const PathMatrix& x, const PrincipalAxes& axes,
                                               const PathMatrix& noise);

}  // namespace kinemark::analysis
