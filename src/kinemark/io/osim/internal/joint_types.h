// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// OpenSim's joints with a fixed motion, as chains of primitive motions. The reader and the writer share them.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kinemark/data/model_description.h"

namespace kinemark::io::osim {

/// One coordinate of a fixed joint: q about or along `axis`.
struct Freedom {
  bool is_rotation = true;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
};

/// Freedoms, in the order of their coordinates, of PinJoint (Z), SliderJoint (X), UniversalJoint (X, Y),
/// PlanarJoint (about Z, along X, Y), BallJoint and GimbalJoint (X, Y, Z), FreeJoint (X, Y, Z, along X, Y,
/// Z), EllipsoidJoint (X, Y, Z) and WeldJoint (none). No value for every other type.
[[nodiscard]] std::optional<std::vector<Freedom>> freedoms_of(std::string_view type);

/// Axes of such a joint driven by `coordinates` (indices).
[[nodiscard]] std::vector<data::AxisDescription> axes_of(std::span<const Freedom> freedoms,
                                                         std::span<const int> coordinates);

/// Translations that keep the child's origin on an ellipsoid while its Z axis, turned by Rx(a) Ry(b), points
/// along the unit sphere: radii times (sin b, -sin a cos b, cos a cos b), entry by entry.
/// @param coordinates  indices of a and b
[[nodiscard]] std::vector<data::AxisDescription> ellipsoid_axes(const Eigen::Vector3d& radii, int a, int b);

/// Scapulothoracic joint (Seth et al. 2016, Front. Neurorobot. 10:13): three rotations while the scapula
/// slides on an ellipsoid, then winging about an axis in the scapular plane whose origin lies away from the
/// joint centre. That offset needs a body between.
struct Scapulothoracic {
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();           ///< x y z of the thorax's joint frame, m
  Eigen::Vector2d winging_origin = Eigen::Vector2d::Zero();  ///< x y in the scapula's joint frame, m
  double winging_direction_rad = 0.0;  ///< from the y axis of the scapula's joint frame, counter-clockwise
};

/// Joints thorax -> body between and body between -> scapula. `joint` has the frames and name of the whole,
/// `coordinates` are abduction, elevation, upward rotation and winging.
struct ScapulothoracicPair {
  data::JointDescription sliding;
  data::JointDescription winging;
};
[[nodiscard]] ScapulothoracicPair split(const data::JointDescription& joint,
                                        const Scapulothoracic& parameters, std::span<const int> coordinates,
                                        int body_between);

/// The undivided joint: inverse of split() for its frames; type and parameters are those of `winging`.
[[nodiscard]] data::JointDescription join(const data::JointDescription& sliding,
                                          const data::JointDescription& winging);

/// Type of the first half of a split scapulothoracic joint; the second half has the type itself.
inline constexpr std::string_view kScapulothoracic = "ScapulothoracicJoint";
inline constexpr std::string_view kScapulothoracicSliding = "ScapulothoracicJoint.sliding";

}  // namespace kinemark::io::osim
