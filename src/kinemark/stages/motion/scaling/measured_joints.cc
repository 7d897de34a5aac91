// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/measured_joints.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/data/name_index.h"
#include "kinemark/math/rotation_fit.h"

namespace kinemark::motion {
namespace {

using Eigen::Index;

constexpr std::size_t kLeastMarkers = 2;  // that tell which body a segment is
constexpr double kLeastMargin = 1e-4;     // of a rotation: below it the markers lie on a line

/// The markers of a segment that sit on one body.
struct OnBody {
  int body = data::kGround;
  std::vector<int> markers;  ///< of the description
  Eigen::Matrix3Xd x;        ///< in the segment
  bool posed = false;        ///< they tell how the segment lies on the body: three or more, not on a line
};

/// The body that carries most markers of a segment; nothing where fewer than two sit on one.
std::optional<OnBody> body_of(const data::ModelDescription& model, const data::NameIndex& names,
                              const data::Skeleton& skeleton, const data::SkeletonSegment& segment) {
  std::map<int, std::vector<std::pair<int, Index>>> votes;  // body: marker of the model, column
  for (std::size_t k = 0; k < segment.markers.size(); ++k) {
    const auto& name = skeleton.markers[at(segment.markers[k])];
    auto m = names.find(name);
    if (m < 0) m = names.find(data::without_prefix(name));
    if (m < 0 || !segment.x_in_segment.col(static_cast<Index>(k)).allFinite()) continue;
    votes[model.markers[at(m)].body_idx].emplace_back(static_cast<int>(m), static_cast<Index>(k));
  }
  votes.erase(data::kGround);
  const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second.size(); });
  if (most == votes.end() || most->second.size() < kLeastMarkers) return std::nullopt;
  OnBody out{.body = most->first, .markers = {}, .x = {}};
  out.x.resize(3, static_cast<Index>(most->second.size()));
  Eigen::Matrix3Xd in_body(3, out.x.cols());
  for (Index k = 0; k < out.x.cols(); ++k) {
    const auto& [marker, column] = most->second[at(k)];
    out.markers.push_back(marker);
    out.x.col(k) = segment.x_in_segment.col(column);
    in_body.col(k) = model.markers[at(marker)].x_in_body;
  }
  out.posed = out.x.cols() >= 3 && math::fit_rigid(out.x, in_body).rotation.margin > kLeastMargin;
  return out;
}

/// The child's origin moves in the parent with a coordinate.
bool moves_its_centre(const data::JointDescription& joint) {
  return std::ranges::any_of(joint.axes,
                             [](const auto& axis) { return !axis.is_rotation && axis.coordinate_idx >= 0; });
}

/// Its centre is known in a segment of which it is known how it lies on its body.
bool has_centre(const data::SkeletonJoint& joint, const OnBody& parent, const OnBody& child) {
  return (parent.posed && joint.centre_in_parent.allFinite()) ||
         (child.posed && joint.centre_in_child.allFinite());
}

}  // namespace

MeasuredJoints match_joints(const data::ModelDescription& model, const data::Skeleton& skeleton) {
  std::vector<std::string> all;
  for (const auto& marker : model.markers) all.push_back(marker.name);
  const data::NameIndex names(all);
  std::vector<std::optional<OnBody>> bodies;
  for (const auto& segment : skeleton.segments) bodies.push_back(body_of(model, names, skeleton, segment));

  MeasuredJoints out;
  const auto leave_out = [&](const data::SkeletonJoint& joint, const std::string& why) {
    out.left_out.push_back(fmt::format("Joint '{}' is not used: {}.", joint.name, why));
  };
  for (const auto& joint : skeleton.joints) {
    const auto &parent = bodies[at(joint.parent_segment)], &child = bodies[at(joint.child_segment)];
    if (!parent || !child) {
      leave_out(joint,
                fmt::format("segment '{}' has fewer than two markers on one body of the model",
                            skeleton.segments[at(parent ? joint.child_segment : joint.parent_segment)].name));
      continue;
    }
    const auto between = std::ranges::find_if(model.joints, [&](const auto& j) {
      return (j.parent_body_idx == parent->body && j.child_body_idx == child->body) ||
             (j.parent_body_idx == child->body && j.child_body_idx == parent->body);
    });
    if (between == model.joints.end()) {
      leave_out(joint,
                parent->body == child->body
                    ? fmt::format("both its segments sit on '{}'", model.bodies[at(parent->body)].name)
                    : fmt::format("no joint of the model connects '{}' and '{}'",
                                  model.bodies[at(parent->body)].name, model.bodies[at(child->body)].name));
      continue;
    }
    if (moves_its_centre(*between)) {
      leave_out(joint, fmt::format("the centre of '{}' moves in the model", between->name));
      continue;
    }
    if (std::ranges::find(out.names, between->name) != out.names.end()) {
      leave_out(joint, fmt::format("'{}' has a centre already", between->name));
      continue;
    }
    const bool reversed = between->parent_body_idx == child->body;
    if (!parent->posed && !child->posed) {
      leave_out(joint, "neither of its segments has three markers, not on a line, on one body of the model");
      continue;
    }
    const std::size_t before = out.joints.size();
    for (const bool first : {true, false}) {
      const auto& on = first ? *parent : *child;
      const auto& C = first ? joint.covariance_in_parent : joint.covariance_in_child;
      const auto& centre = first ? joint.centre_in_parent : joint.centre_in_child;
      if (!on.posed || !C.allFinite() || !centre.allFinite() || !(C.trace() > 0.0)) continue;
      out.joints.push_back({.joint = between->name,
                            .in_parent = first != reversed,
                            .markers = on.markers,
                            .x = on.x,
                            .centre = centre,
                            .covariance = C});
    }
    if (out.joints.size() == before)
      leave_out(joint, has_centre(joint, *parent, *child) ? "its centre has no covariance"
                                                          : "its centre is not known");
    else
      out.names.push_back(between->name);
  }
  return out;
}

}  // namespace kinemark::motion
