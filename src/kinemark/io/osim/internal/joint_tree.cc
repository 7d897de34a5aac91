// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <deque>

#include "kinemark/io/osim/internal/joint_xml.h"

namespace kinemark::io::osim {

using data::AxisDescription;
using data::JointDescription;
using data::ModelDescription;

namespace {

int add_massless_body(ModelDescription& description, const std::string& name) {
  description.bodies.push_back({.name = name});
  return static_cast<int>(description.bodies.size()) - 1;
}

/// Rotations undone in the opposite order, or translations by the opposite amount.
std::vector<AxisDescription> inverse_axes(const std::vector<AxisDescription>& axes, bool rotations) {
  std::vector<AxisDescription> inverse;
  for (const AxisDescription& axis : axes)
    if (axis.is_rotation == rotations) inverse.push_back(axis);
  std::ranges::reverse(inverse);
  for (AxisDescription& axis : inverse) axis.function = axis.function.scaled(-1.0);
  return inverse;
}

void add_reversed(const JointDescription& joint, ModelDescription& description) {
  JointDescription reversed_joint = joint;
  reversed_joint.type = "CustomJoint";
  reversed_joint.parameters.clear();
  std::swap(reversed_joint.parent_body_idx, reversed_joint.child_body_idx);
  std::swap(reversed_joint.parent_from_joint, reversed_joint.child_from_joint);
  auto rotations = inverse_axes(joint.axes, true), translations = inverse_axes(joint.axes, false);
  if (!rotations.empty() && !translations.empty()) {
    const int between = add_massless_body(description, joint.name + "_intermediate");
    JointDescription first = reversed_joint;
    first.name += "_rotation";
    first.child_body_idx = between;
    first.child_from_joint = {};
    first.axes = std::move(rotations);
    description.joints.push_back(std::move(first));
    reversed_joint.parent_body_idx = between;
    reversed_joint.parent_from_joint = {};
    rotations.clear();
  }
  reversed_joint.axes = rotations.empty() ? std::move(translations) : std::move(rotations);
  if (reversed_joint.axes.empty()) reversed_joint.type = "WeldJoint";
  description.joints.push_back(std::move(reversed_joint));
}

void add_scapulothoracic(const FileJoint& joint, ModelDescription& description) {
  const JointDescription& d = joint.description;
  const int between = add_massless_body(description, d.name + "_intermediate");
  const Scapulothoracic parameters{.radii = {d.parameters[0], d.parameters[1], d.parameters[2]},
                                   .winging_origin = {d.parameters[3], d.parameters[4]},
                                   .winging_direction_rad = d.parameters[5]};
  ScapulothoracicPair pair = split(d, parameters, joint.coordinates, between);
  description.joints.push_back(std::move(pair.sliding));
  description.joints.push_back(std::move(pair.winging));
}

enum class Direction { unknown, as_written, reversed };

/// From the ground outwards, against a joint's direction only where no other path exists.
std::vector<Direction> directions(const std::vector<FileJoint>& joints, std::vector<bool>& reached) {
  const auto slot = [](int body) { return static_cast<std::size_t>(body + 1); };  // 0: ground
  std::vector<std::vector<std::size_t>> by_parent(reached.size()), by_child(reached.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    by_parent[slot(joints[j].description.parent_body_idx)].push_back(j);
    by_child[slot(joints[j].description.child_body_idx)].push_back(j);
  }
  std::vector<Direction> direction(joints.size(), Direction::unknown);
  std::deque<std::size_t> outwards, inwards;
  const auto reach = [&](std::size_t body) {
    reached[body] = true;
    for (const std::size_t j : by_parent[body]) outwards.push_back(j);
    for (const std::size_t j : by_child[body]) inwards.push_back(j);
  };
  reach(0);
  while (!outwards.empty() || !inwards.empty()) {
    const bool forward = !outwards.empty();
    auto& queue = forward ? outwards : inwards;
    const std::size_t j = queue.front();
    queue.pop_front();
    const auto& d = joints[j].description;
    const std::size_t next = slot(forward ? d.child_body_idx : d.parent_body_idx);
    if (direction[j] != Direction::unknown || reached[next]) continue;
    direction[j] = forward ? Direction::as_written : Direction::reversed;
    reach(next);
  }
  return direction;
}

}  // namespace

void hang_from_ground(XmlFile& file, std::vector<FileJoint> joints, ModelDescription& description) {
  std::vector<bool> reached(description.bodies.size() + 1, false);
  const auto direction = directions(joints, reached);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointDescription& d = joints[j].description;
    const bool scapulothoracic = d.type == kScapulothoracic;
    if (direction[j] == Direction::unknown) {
      if (reached[static_cast<std::size_t>(d.child_body_idx + 1)])
        file.note(joints[j].node, "closes a loop of joints; only one joint may lead to a body",
                  Code::not_supported);
    } else if (direction[j] == Direction::reversed) {
      if (!d.parameters.empty())
        file.note(
            joints[j].node,
            fmt::format("is a {} whose child is nearer to the ground than its parent, which is not supported",
                        d.type),
            Code::not_supported);
      add_reversed(d, description);
    } else if (scapulothoracic && d.parameters.size() == 6 && joints[j].coordinates.size() == 4) {
      add_scapulothoracic(joints[j], description);
    } else {
      description.joints.push_back(d);
    }
  }
  for (std::size_t b = 0; b + 1 < reached.size(); ++b)
    if (!reached[b + 1])
      file.note({}, fmt::format("body {}: no joints connect it to the ground",
                                in_quotes(description.bodies[b].name)));
}

}  // namespace kinemark::io::osim
