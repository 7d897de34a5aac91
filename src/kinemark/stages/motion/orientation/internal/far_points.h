// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Orientations beside markers: a body that a sensor turns carries four points so far away that where the body
// is hardly counts. Theory: docs/theory/orientations.md
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::motion::internal {

/// Distance of the points, m: their sum of squares about each axis is its square.
inline constexpr double kFar_m = 30.0;
inline constexpr int kCorners = 4;  ///< points of a sensor

/// Corners of a tetrahedron about the body's origin, m: their sum is 0, that of their products with
/// themselves kFar_m^2 times the identity. So the squared distances of the corners of two bodies add up to
/// kFar_m^2 |R - S|^2 (Frobenius) and kCorners times the squared distance of their origins, and nothing else.
[[nodiscard]] Eigen::Matrix<double, 3, kCorners> far_corners();

/// Weight of a corner beside markers of weight 1: variance of an orientation about each axis (rad^2), and of
/// a marker per axis (m^2).
[[nodiscard]] double far_weight(double marker_variance_m2, double orientation_variance_rad2);

/// The model with the corners of sensors on these bodies (of the description) behind its markers.
[[nodiscard]] data::ModelDescription add_far_points(data::ModelDescription model,
                                                    const std::vector<int>& bodies);

/// The recording with the corners behind its markers.
/// @param turned  world_from_body of each sensor, F x S; NaN where it is missing
/// @param origin  about where the body is, F x S, m
[[nodiscard]] data::Trajectories add_far_points(const data::Trajectories& markers,
                                                const std::vector<Eigen::Matrix3d>& turned,
                                                const std::vector<Eigen::Vector3d>& origin);

}  // namespace kinemark::motion::internal
