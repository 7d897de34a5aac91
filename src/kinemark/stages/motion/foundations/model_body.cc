// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/foundations/internal/body_parts.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What a body's name tells of it. Turns about x, y, z: SD in degrees.
struct BodyKind {
  std::string_view begin;  // of the name, lower case
  std::string_view size;
  std::string_view width;  // size along z; empty: as size
  std::array<double, 3> turn_deg;
  double joint_common, joint_own;
  double joint_by_posture = 0.0;
};

constexpr std::array kKinds{
    BodyKind{"pelvis", "pelvis", "pelvis width", {10, 12, 20}, 0.0, 0.0},
    BodyKind{"femur", "thigh", "", {12, 15, 30}, 0.012, 0.004},
    BodyKind{"thigh", "thigh", "", {12, 15, 30}, 0.012, 0.004},
    BodyKind{"tibia", "shank", "", {4, 9, 25}, 0.006, 0.003},
    BodyKind{"shank", "shank", "", {4, 9, 25}, 0.006, 0.003},
    BodyKind{"talus", "foot", "", {4, 6, 15}, 0.005, 0.003},
    BodyKind{"calcn", "foot", "", {8, 8, 5}, 0.002, 0.002},
    BodyKind{"foot", "foot", "", {9, 9, 15}, 0.004, 0.003},
    BodyKind{"toes", "foot", "", {4, 4, 10}, 0.004, 0.003},
    BodyKind{"torso", "trunk", "trunk width", {10, 12, 20}, 0.020, 0.0, 0.025},
    BodyKind{"thorax", "trunk", "trunk width", {10, 12, 20}, 0.020, 0.0, 0.025},
    BodyKind{"abdomen", "trunk", "trunk width", {10, 12, 20}, 0.020, 0.0, 0.025},
    BodyKind{"trunk", "trunk", "trunk width", {10, 12, 20}, 0.020, 0.0, 0.025},
    BodyKind{"head", "head", "", {15, 30, 25}, 0.020, 0.0, 0.015},
    BodyKind{"clavicle", "trunk", "trunk width", {10, 10, 10}, 0.010, 0.008, 0.008},
    BodyKind{"scapula", "trunk", "trunk width", {15, 15, 15}, 0.010, 0.008, 0.008},
    BodyKind{"humerus", "upper arm", "", {60, 60, 60}, 0.020, 0.015, 0.012},
    BodyKind{"ulna", "forearm", "", {8, 20, 60}, 0.006, 0.004, 0.004},
    BodyKind{"radius", "forearm", "", {4, 50, 4}, 0.004, 0.003, 0.004},
    BodyKind{"hand", "hand", "", {25, 10, 40}, 0.006, 0.004, 0.004},
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

Side side_of_body(const std::string& name) {
  const std::string text = lower(name);
  if (text.ends_with("_r") || text.starts_with("r_") || text.starts_with("right")) return Side::right;
  if (text.ends_with("_l") || text.starts_with("l_") || text.starts_with("left")) return Side::left;
  return Side::middle;
}

/// Name without its side.
std::string stem_of_body(const std::string& name) {
  std::string text = lower(name);
  for (const std::string_view begin : {"right", "left", "r_", "l_"})
    if (text.starts_with(begin)) text = text.substr(begin.size());
  if (text.ends_with("_r") || text.ends_with("_l")) text.resize(text.size() - 2);
  return text;
}

const BodyKind* kind_of(const std::string& stem) {
  const auto found =
      std::ranges::find_if(kKinds, [&](const BodyKind& k) { return stem.starts_with(k.begin); });
  return found == kKinds.end() ? nullptr : &*found;
}

/// Up against gravity, right as the markers' names tell, else the model's z.
Matrix3d standing_axes(const data::ModelDescription& model, const model::Workspace& w) {
  const Vector3d up = model.gravity.norm() > 1e-9 ? Vector3d(-model.gravity.normalized()) : Vector3d::UnitY();
  Vector3d right = Vector3d::Zero();
  for (std::size_t i = 0; i < model.markers.size(); ++i)
    for (std::size_t j = 0; j < model.markers.size(); ++j) {
      const auto a = split_marker_name(model.markers[i].name), b = split_marker_name(model.markers[j].name);
      if (a.side != Side::right || b.side != Side::left || a.stem != b.stem) continue;
      right += w.marker.col(static_cast<Eigen::Index>(i)) - w.marker.col(static_cast<Eigen::Index>(j));
    }
  right -= right.dot(up) * up;
  if (right.norm() < 0.02) right = Vector3d::UnitZ() - Vector3d::UnitZ().dot(up) * up;
  if (right.norm() < 1e-6) return Matrix3d::Identity();
  right.normalize();
  Matrix3d rows;
  rows << up.cross(right).transpose(), up.transpose(), right.transpose();
  return rows;
}

bool turns(const data::ModelDescription& model, const data::JointDescription& joint) {
  return std::ranges::any_of(joint.axes, [&](const data::AxisDescription& axis) {
    if (!axis.is_rotation || axis.coordinate_idx < 0) return false;
    if (model.coordinates[at(axis.coordinate_idx)].held()) return false;
    return std::ranges::none_of(model.couplings,
                                [&](const auto& c) { return c.dependent_idx == axis.coordinate_idx; });
  });
}

StandingBody::Segment segment_of(const std::string& name, StandingBody& body) {
  StandingBody::Segment out;
  out.name = name;
  out.side = side_of_body(name);
  const BodyKind* kind = kind_of(stem_of_body(name));
  const std::string size = kind == nullptr ? stem_of_body(name) : std::string(kind->size);
  out.size = internal::add_size(body, size, out.side);
  if (kind == nullptr) return out;
  // Clavicles and scapulae go with the trunk, which both sides share.
  if (size == "trunk") out.size = internal::add_size(body, size, Side::middle);
  if (!kind->width.empty()) out.width = internal::add_size(body, std::string(kind->width), Side::middle);
  out.turn_sd = internal::kDegree * Vector3d(kind->turn_deg[0], kind->turn_deg[1], kind->turn_deg[2]);
  out.joint_common_sd = kind->joint_common;
  out.joint_own_sd = kind->joint_own;
  out.joint_by_posture = kind->joint_by_posture;
  return out;
}

/// Adds a segment beside the same one of the other side.
/// @return its index
int pair_segment(StandingBody::Segment segment, StandingBody& body) {
  const auto index = static_cast<int>(body.segments.size());
  for (std::size_t s = 0; s < body.segments.size() && segment.side != Side::middle; ++s)
    if (body.segments[s].side != segment.side &&
        stem_of_body(body.segments[s].name) == stem_of_body(segment.name)) {
      segment.mirror = static_cast<int>(s);
      body.segments[s].mirror = index;
    }
  body.segments.push_back(std::move(segment));
  return index;
}

/// Where a model's arm hangs from a trunk without clavicle, its shoulder is a segment of its own, as in the
/// body of names: acromia move on the trunk. Joints are counted from the trunk's.
StandingBody::Segment shoulder_of(const StandingBody& body, const StandingBody::Segment& arm,
                                  const Vector3d& arm_in_trunk) {
  StandingBody::Segment out;
  out.name = arm.side == Side::left ? "left shoulder" : "right shoulder";
  out.parent = arm.parent;
  out.side = arm.side;
  out.joint_in_parent = arm_in_trunk + Vector3d(0.050, -0.0065, arm.side == Side::left ? 0.1616 : -0.1616);
  out.turn_sd = internal::kDegree * Vector3d(16, 14, 8);
  out.joint_common_sd = 0.015;
  out.joint_own_sd = 0.006;
  out.joint_by_posture = 0.008;
  out.size = body.segments[at(arm.parent)].size;
  out.width = body.segments[at(arm.parent)].width;
  return out;
}

/// The shoulder that an acromion at `here` belongs to, made where no arm hangs from the trunk.
int shoulder_on(int trunk, Side side, const Vector3d& here, StandingBody& body,
                std::vector<Vector3d>& joint) {
  for (std::size_t s = 0; s < body.segments.size(); ++s)
    if (body.segments[s].parent == trunk && body.segments[s].side == side &&
        body.segments[s].name.ends_with(" shoulder"))
      return static_cast<int>(s);
  StandingBody::Segment arm;
  arm.parent = trunk;
  arm.side = side;
  const Vector3d arm_from_acromion(0.010, -0.0535, side == Side::left ? -0.0116 : 0.0116);
  auto shoulder = shoulder_of(body, arm, here - joint[at(trunk)] + arm_from_acromion);
  joint.push_back(joint[at(trunk)] + shoulder.joint_in_parent);
  return pair_segment(std::move(shoulder), body);
}

}  // namespace

Result<StandingBody> body_of_model(const data::ModelDescription& model) {
  auto compiled = model::Model::compile(model);
  if (!compiled) return std::unexpected(compiled.error());
  model::Workspace w(*compiled);
  model::kinematics(*compiled, w, compiled->default_state());
  const Matrix3d turn = standing_axes(model, w);

  StandingBody out;
  const auto bodies = compiled->bodies();
  std::vector<int> segment_of_body(bodies.size(), -1);
  std::vector<Vector3d> joint;  // of each segment, standing axes
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& body = bodies[b];
    const auto& description = model.bodies[at(body.description_idx)];
    const auto j =
        std::ranges::find(model.joints, body.description_idx, &data::JointDescription::child_body_idx);
    const bool first = body.parent == data::kGround;
    if (!first && !turns(model, *j)) {
      segment_of_body[b] = segment_of_body[at(body.parent)];
      continue;
    }
    StandingBody::Segment segment = segment_of(description.name, out);
    const Vector3d here =
        turn * (w.position[b] +
                (first ? Vector3d::Zero() : Vector3d(w.rotation[b] * j->child_from_joint.translation)));
    // A second body on the ground hangs from the first one, by a joint that may be anywhere.
    segment.parent = first ? (out.segments.empty() ? -1 : 0) : segment_of_body[at(body.parent)];
    if (segment.parent >= 0) segment.joint_in_parent = here - joint[at(segment.parent)];
    const BodyKind* const kind = kind_of(stem_of_body(segment.name));
    if (segment.parent >= 0 && segment.side != Side::middle && kind != nullptr && kind->size == "upper arm" &&
        out.segments[at(segment.parent)].side == Side::middle) {
      auto shoulder = shoulder_of(out, segment, segment.joint_in_parent);
      joint.push_back(joint[at(shoulder.parent)] + shoulder.joint_in_parent);
      segment.parent = pair_segment(std::move(shoulder), out);
      segment.joint_in_parent = here - joint.back();
      segment.joint_common_sd = 0.015;
      segment.joint_own_sd = 0.010;
    }
    if (first && segment.parent >= 0) segment.joint_common_sd = segment.joint_own_sd = 1.0;
    segment_of_body[b] = pair_segment(std::move(segment), out);
    joint.push_back(here);
  }
  for (std::size_t m = 0; m < model.markers.size(); ++m) {
    const int b = compiled->markers()[m].body;
    if (b == data::kGround) continue;
    StandingBody::Marker marker;
    marker.name = model.markers[m].name;
    marker.segment = segment_of_body[at(b)];
    const auto landmark = landmark_of(marker.name);
    if (landmark && landmark->part == BodyPart::shoulder && landmark->side != Side::middle &&
        out.segments[at(marker.segment)].side == Side::middle)
      marker.segment = shoulder_on(marker.segment, landmark->side,
                                   turn * w.marker.col(static_cast<Eigen::Index>(m)), out, joint);
    marker.x_in_segment = turn * w.marker.col(static_cast<Eigen::Index>(m)) - joint[at(marker.segment)];
    if (landmark) marker.spread = landmark->spread;
    out.markers.push_back(std::move(marker));
  }
  internal::pair_markers(out);
  return out;
}

}  // namespace kinemark::motion
