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

// How one straight piece of a path bends around a cylinder: by the rules of OpenSim's WrapCylinder, so that
// lengths agree with those of its ScaleTool.

/// What a cylinder does to a piece of a path.
enum class Contact {
  none,      ///< the piece passes it by
  inside,    ///< an end lies within its radius: nothing can be done
  possible,  ///< it may bend around
  needed     ///< it goes through, so that it must bend around
};

/// A piece that bends: straight to `onto`, along the surface, straight on from `off`.
struct CylinderWrap {
  Contact contact = Contact::none;
  Eigen::Vector3d onto = Eigen::Vector3d::Zero();  ///< in the surface's frame, m
  Eigen::Vector3d off = Eigen::Vector3d::Zero();   ///< in the surface's frame, m
  double arc_m = 0.0;                              ///< along the surface, from onto to off
};

/// The piece from `from` to `to`, both in the surface's frame (m).
///
/// The points where it touches lie where the plane through both ends and the cylinder's edge between them
/// meets the lines of tangency. `settle` then slides them along the cylinder until the way enters and leaves
/// the helix without a kink (0.1 deg): so OpenSim does for a path with several surfaces, and only there.
[[nodiscard]] CylinderWrap wrap_cylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                         const data::WrapSurface& cylinder, bool settle);

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
