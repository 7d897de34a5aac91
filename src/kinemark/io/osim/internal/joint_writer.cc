// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/joint_writer.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/function_xml.h"
#include "kinemark/io/osim/internal/joint_types.h"
#include "kinemark/math/euler.h"

namespace kinemark::io::osim {

using data::AxisDescription;
using data::JointDescription;
using data::ModelDescription;
using Eigen::Vector3d;

namespace {

bool same_function(const math::ScalarFunction& a, const math::ScalarFunction& b) {
  return a.kind() == b.kind() && a.factor() == b.factor() && a.coefficients() == b.coefficients() &&
         a.knots_x() == b.knots_x() && a.knots_y() == b.knots_y();
}

bool same_axis(const AxisDescription& a, const AxisDescription& b) {
  return a.is_rotation == b.is_rotation && a.axis == b.axis && a.coordinate_idx == b.coordinate_idx &&
         a.second_coordinate_idx == b.second_coordinate_idx && same_function(a.function, b.function) &&
         (a.second_coordinate_idx < 0 || same_function(a.second_function, b.second_function));
}

bool same_axes(const std::vector<AxisDescription>& a, const std::vector<AxisDescription>& b) {
  return std::ranges::equal(a, b, same_axis);
}

/// Coordinates in the order of the axes, each once.
std::vector<int> coordinates_of(const JointDescription& joint) {
  std::vector<int> coordinates;
  for (const AxisDescription& axis : joint.axes)
    for (const int idx : {axis.coordinate_idx, axis.second_coordinate_idx})
      if (idx >= 0 && std::ranges::find(coordinates, idx) == coordinates.end()) coordinates.push_back(idx);
  return coordinates;
}

/// The axes are exactly those that OpenSim builds for the joint's type, with coordinates in the file's order.
bool keeps_its_type(const JointDescription& joint) {
  const auto freedoms = freedoms_of(joint.type);
  const auto coordinates = coordinates_of(joint);
  if (!freedoms || coordinates.size() != freedoms->size() || !std::ranges::is_sorted(coordinates))
    return false;
  auto axes = axes_of(*freedoms, coordinates);
  if (joint.type == "EllipsoidJoint") {
    if (joint.parameters.size() != 3) return false;
    const Vector3d radii(joint.parameters[0], joint.parameters[1], joint.parameters[2]);
    for (auto& axis : ellipsoid_axes(radii, coordinates[0], coordinates[1])) axes.push_back(axis);
  }
  return same_axes(axes, joint.axes);
}

bool parallel(const Vector3d& a, const Vector3d& b) {
  return a.normalized().cross(b.normalized()).norm() < 1e-5;
}

/// Three axes of one kind, the ones in use first; OpenSim wants the others too, not parallel to any.
Result<std::array<AxisDescription, 3>> three_axes(const JointDescription& joint, bool rotations) {
  std::vector<AxisDescription> axes;
  for (const AxisDescription& axis : joint.axes)
    if (axis.is_rotation == rotations) axes.push_back(axis);
  const auto refuse = [&](std::string_view why) {
    return fail(Code::not_supported,
                fmt::format("joint '{}' {}, which OpenSim cannot represent", joint.name, why));
  };
  if (axes.size() > 3)
    return refuse(rotations ? "has more than three rotations" : "has more than three translations");
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].second_coordinate_idx >= 0) return refuse("has an axis that depends on two coordinates");
    if (axes[i].function.kind() == math::ScalarFunction::Kind::natural_spline)
      return refuse("moves by a natural spline");
    for (std::size_t k = 0; k < i; ++k)
      if (parallel(axes[i].axis, axes[k].axis)) return refuse("has parallel axes");
  }
  for (int i = 0; i < 3 && axes.size() < 3; ++i) {
    const Vector3d unit = Vector3d::Unit(i);
    if (std::ranges::none_of(axes, [&](const auto& axis) { return parallel(axis.axis, unit); }))
      axes.push_back(
          {.is_rotation = rotations, .axis = unit, .function = math::ScalarFunction::constant(0.0)});
  }
  return std::array{axes[0], axes[1], axes[2]};
}

void write_axis(pugi::xml_node transform, const ModelDescription& description, const AxisDescription& axis,
                std::string_view name) {
  pugi::xml_node node = append_named(transform, "TransformAxis", name);
  append_text(node, "coordinates",
              axis.coordinate_idx < 0
                  ? ""
                  : description.coordinates[static_cast<std::size_t>(axis.coordinate_idx)].name);
  append_vector3(node, "axis", axis.axis);
  write_function(
      node, "function",
      axis.coordinate_idx < 0 ? math::ScalarFunction::constant(axis.function(0.0).f) : axis.function);
}

Status write_spatial_transform(pugi::xml_node node, const ModelDescription& description,
                               const JointDescription& joint) {
  pugi::xml_node transform = node.append_child("SpatialTransform");
  for (const bool rotations : {true, false}) {
    const auto axes = three_axes(joint, rotations);
    if (!axes) return std::unexpected(axes.error());
    for (std::size_t i = 0; i < 3; ++i)
      write_axis(transform, description, (*axes)[i],
                 fmt::format("{}{}", rotations ? "rotation" : "translation", i + 1));
  }
  return {};
}

/// OpenSim's default motion type of a coordinate.
bool acts_as_rotation(const JointDescription& joint, int idx) {
  return std::ranges::any_of(
      joint.axes, [&](const auto& axis) { return axis.coordinate_idx == idx && axis.is_rotation; });
}

void write_coordinate(pugi::xml_node coordinates, const data::CoordinateDescription& c,
                      bool acts_as_rotation) {
  pugi::xml_node node = append_named(coordinates, "Coordinate", c.name);
  if (c.is_rotation != acts_as_rotation)
    append_text(node, "motion_type", c.is_rotation ? "rotational" : "translational");
  append_number(node, "default_value", c.default_value);
  const data::CoordinateDescription unlimited;
  if (c.range_min != unlimited.range_min || c.range_max != unlimited.range_max || c.clamped)
    append_numbers(node, "range", {c.range_min, c.range_max});
  append_flag(node, "clamped", c.clamped);
  append_flag(node, "locked", c.locked);
  if (c.prescribed) {
    write_function(node, "prescribed_function", *c.prescribed);
    append_flag(node, "prescribed", true);
  }
}

bool is_identity(const math::SE3& frame) {
  return frame.rotation == Eigen::Matrix3d::Identity() && frame.translation == Vector3d::Zero();
}

/// The name in the joint's socket: the body itself, or an offset frame of the joint that is added to
/// `frames`.
std::string attach(pugi::xml_node frames, const ModelDescription& description, int body_idx,
                   const math::SE3& frame, std::string_view name) {
  std::string path = body_path(description, body_idx);
  if (is_identity(frame)) return path;
  pugi::xml_node node = append_named(frames, "PhysicalOffsetFrame", name);
  append_text(node, "socket_parent", path);
  append_vector3(node, "translation", frame.translation);
  append_vector3(node, "orientation", math::to_body_xyz(frame.rotation));
  return std::string(name);
}

/// A joint without coordinates can still hold a constant displacement: it moves into the parent's frame.
JointDescription as_weld(const JointDescription& joint) {
  JointDescription weld = joint;
  math::SE3 motion;
  for (const AxisDescription& axis : joint.axes) {
    const double value = axis.function(0.0).f;
    if (axis.is_rotation)
      motion.rotation = motion.rotation * math::axis_angle(axis.axis.normalized(), value);
    else
      motion.translation += axis.axis.normalized() * value;
  }
  weld.type = "WeldJoint";
  weld.parent_from_joint = joint.parent_from_joint * motion;
  weld.axes.clear();
  return weld;
}

Status write_whole_joint(pugi::xml_node objects, const ModelDescription& description,
                         const JointDescription& joint, const char* tag) {
  pugi::xml_node node = append_named(objects, tag, joint.name);
  pugi::xml_node parent = node.append_child("socket_parent_frame"),
                 child = node.append_child("socket_child_frame");
  pugi::xml_node coordinates = node.append_child("coordinates");
  auto indices = coordinates_of(joint);
  std::ranges::sort(indices);
  for (const int idx : indices)
    write_coordinate(coordinates, description.coordinates[static_cast<std::size_t>(idx)],
                     acts_as_rotation(joint, idx));
  pugi::xml_node frames = node.append_child("frames");
  parent.text().set(
      attach(frames, description, joint.parent_body_idx, joint.parent_from_joint, "parent_offset").c_str());
  child.text().set(
      attach(frames, description, joint.child_body_idx, joint.child_from_joint, "child_offset").c_str());
  const auto& p = joint.parameters;
  if (std::string_view(tag) == "CustomJoint") return write_spatial_transform(node, description, joint);
  if (joint.type == "EllipsoidJoint") append_numbers(node, "radii_x_y_z", p);
  if (joint.type == kScapulothoracic) {
    append_numbers(node, "thoracic_ellipsoid_radii_x_y_z", {p[0], p[1], p[2]});
    append_numbers(node, "scapula_winging_axis_origin", {p[3], p[4]});
    append_number(node, "scapula_winging_axis_direction", p[5]);
  }
  return {};
}

}  // namespace

std::string body_path(const ModelDescription& description, int body_idx) {
  return body_idx < 0 ? "/ground" : "/bodyset/" + description.bodies[static_cast<std::size_t>(body_idx)].name;
}

int find_sliding_half(const ModelDescription& description, const JointDescription& winging) {
  if (winging.type != kScapulothoracic || winging.parameters.size() != 6) return -1;
  const int between = winging.parent_body_idx;
  int sliding = -1, users = 0;
  for (std::size_t j = 0; j < description.joints.size(); ++j) {
    const JointDescription& joint = description.joints[j];
    if (joint.child_body_idx == between && joint.type == kScapulothoracicSliding)
      sliding = static_cast<int>(j);
    if (joint.parent_body_idx == between) ++users;
  }
  for (const auto& marker : description.markers) users += marker.body_idx == between;
  for (const auto& c : description.point_constraints)
    users += c.body_a_idx == between || c.body_b_idx == between;
  if (sliding < 0 || users != 1 || description.bodies[static_cast<std::size_t>(between)].mass != 0.0)
    return -1;
  const JointDescription& first = description.joints[static_cast<std::size_t>(sliding)];
  const JointDescription whole = join(first, winging);
  const auto coordinates = coordinates_of(whole);
  if (coordinates.size() != 4 || !std::ranges::is_sorted(coordinates)) return -1;
  const auto& p = winging.parameters;
  const auto pair = split(whole, {{p[0], p[1], p[2]}, {p[3], p[4]}, p[5]}, coordinates, between);
  const bool unchanged = same_axes(pair.sliding.axes, first.axes) &&
                         same_axes(pair.winging.axes, winging.axes) &&
                         pair.sliding.child_from_joint.rotation == first.child_from_joint.rotation &&
                         pair.winging.parent_from_joint.translation == winging.parent_from_joint.translation;
  return unchanged ? sliding : -1;
}

Status write_joint(pugi::xml_node objects, const ModelDescription& description,
                   const JointDescription& joint) {
  if (const int sliding = find_sliding_half(description, joint); sliding >= 0)
    return write_whole_joint(objects, description,
                             join(description.joints[static_cast<std::size_t>(sliding)], joint),
                             "ScapulothoracicJoint");
  if (keeps_its_type(joint)) return write_whole_joint(objects, description, joint, joint.type.c_str());
  if (coordinates_of(joint).empty())
    return write_whole_joint(objects, description, as_weld(joint), "WeldJoint");
  return write_whole_joint(objects, description, joint, "CustomJoint");
}

}  // namespace kinemark::io::osim
