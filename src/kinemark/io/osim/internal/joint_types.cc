// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/joint_types.h"

#include <cmath>
#include <numbers>

namespace kinemark::io::osim {

using data::AxisDescription;
using data::JointDescription;
using Eigen::Vector3d;
using math::ScalarFunction;

namespace {

/// Quarter turn about Z, exact.
math::SE3 quarter_rotation() {
  math::SE3 quarter;
  quarter.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return quarter;
}

ScalarFunction cosine(double amplitude) {
  return ScalarFunction::sine(amplitude, 1.0, std::numbers::pi / 2, 0.0);
}

Vector3d winging_origin_of(const JointDescription& winging) { return winging.parent_from_joint.translation; }

}  // namespace

std::optional<std::vector<Freedom>> freedoms_of(std::string_view type) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  if (type == "WeldJoint") return std::vector<Freedom>{};
  if (type == "PinJoint") return std::vector<Freedom>{{true, z}};
  if (type == "SliderJoint") return std::vector<Freedom>{{false, x}};
  if (type == "UniversalJoint") return std::vector<Freedom>{{true, x}, {true, y}};
  if (type == "PlanarJoint") return std::vector<Freedom>{{true, z}, {false, x}, {false, y}};
  if (type == "BallJoint" || type == "GimbalJoint" || type == "EllipsoidJoint")
    return std::vector<Freedom>{{true, x}, {true, y}, {true, z}};
  if (type == "FreeJoint")
    return std::vector<Freedom>{{true, x}, {true, y}, {true, z}, {false, x}, {false, y}, {false, z}};
  return std::nullopt;
}

std::vector<AxisDescription> axes_of(std::span<const Freedom> freedoms, std::span<const int> coordinates) {
  std::vector<AxisDescription> axes;
  for (std::size_t i = 0; i < freedoms.size(); ++i)
    axes.push_back(
        {.is_rotation = freedoms[i].is_rotation, .axis = freedoms[i].axis, .coordinate_idx = coordinates[i]});
  return axes;
}

std::vector<AxisDescription> ellipsoid_axes(const Vector3d& radii, int a, int b) {
  const AxisDescription x{.is_rotation = false,
                          .axis = Vector3d::UnitX(),
                          .coordinate_idx = b,
                          .function = ScalarFunction::sine(radii.x(), 1.0, 0.0, 0.0)};
  const AxisDescription y{.is_rotation = false,
                          .axis = Vector3d::UnitY(),
                          .coordinate_idx = a,
                          .function = ScalarFunction::sine(-radii.y(), 1.0, 0.0, 0.0),
                          .second_coordinate_idx = b,
                          .second_function = cosine(1.0)};
  const AxisDescription z{.is_rotation = false,
                          .axis = Vector3d::UnitZ(),
                          .coordinate_idx = a,
                          .function = cosine(radii.z()),
                          .second_coordinate_idx = b,
                          .second_function = cosine(1.0)};
  return {x, y, z};
}

ScapulothoracicPair split(const JointDescription& joint, const Scapulothoracic& parameters,
                          std::span<const int> coordinates, int body_between) {
  // The ellipsoid's frames are rotated by 90 deg about Z on both sides, so that abduction and elevation are
  // positive; in the rotated frame the thorax's x and y radii are exchanged.
  const Vector3d radii(parameters.radii.y(), parameters.radii.x(), parameters.radii.z());
  ScapulothoracicPair pair;
  pair.sliding = {.name = joint.name + "_sliding",
                  .type = std::string(kScapulothoracicSliding),
                  .parent_body_idx = joint.parent_body_idx,
                  .child_body_idx = body_between,
                  .parent_from_joint = joint.parent_from_joint * quarter_rotation(),
                  .child_from_joint = quarter_rotation()};
  pair.sliding.axes = axes_of(*freedoms_of("EllipsoidJoint"), coordinates.first(3));
  for (auto& axis : ellipsoid_axes(radii, coordinates[0], coordinates[1])) pair.sliding.axes.push_back(axis);

  const math::SE3 to_origin{
      .translation = {parameters.winging_origin.x(), parameters.winging_origin.y(), 0.0}};
  const double w = parameters.winging_direction_rad;
  pair.winging = joint;
  pair.winging.type = kScapulothoracic;
  pair.winging.parent_body_idx = body_between;
  pair.winging.parent_from_joint = to_origin;
  pair.winging.child_from_joint = joint.child_from_joint * to_origin;
  pair.winging.axes = {{.axis = {-std::sin(w), std::cos(w), 0.0}, .coordinate_idx = coordinates[3]}};
  pair.winging.parameters = {parameters.radii.x(),          parameters.radii.y(),
                             parameters.radii.z(),          parameters.winging_origin.x(),
                             parameters.winging_origin.y(), w};
  return pair;
}

JointDescription join(const JointDescription& sliding, const JointDescription& winging) {
  JointDescription joint = winging;
  joint.parent_body_idx = sliding.parent_body_idx;
  joint.parent_from_joint = sliding.parent_from_joint * quarter_rotation().inverse();
  joint.child_from_joint = winging.child_from_joint * math::SE3{.translation = -winging_origin_of(winging)};
  joint.axes = sliding.axes;
  joint.axes.push_back(winging.axes.front());
  return joint;
}

}  // namespace kinemark::io::osim
