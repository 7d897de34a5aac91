// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The length of a path over its points and around the cylinders between them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/data/muscle_path.h"
#include "kinemark/math/se3.h"

namespace kinemark::motion::internal {

/// A point that the path runs over in a pose.
struct PassedPoint {
  int point_idx;               ///< of the path's points
  Eigen::Vector3d x_in_world;  ///< m
};

/// Length of the path, m: straight from point to point, and around those of its surfaces that are active
/// cylinders where it meets them. Cylinders are tried in turn, each on what the others left of the path, as
/// OpenSim's GeometryPath tries them: up to eight times, until the length changes by less than 0.5 mm.
///
/// @param points  those that count in the pose, in the path's order
/// @param wraps  of the path
/// @param world_from_surface  pose of the surface of each of `wraps`
[[nodiscard]] double wrapped_length(std::span<const PassedPoint> points,
                                    std::span<const data::PathWrap> wraps,
                                    std::span<const math::SE3> world_from_surface);

}  // namespace kinemark::motion::internal
