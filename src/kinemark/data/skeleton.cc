// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/skeleton.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <string>

#include "kinemark/core/enum_names.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::data {

std::string_view to_string(SegmentKind kind) {
  static constexpr EnumNames<SegmentKind::solid> kNames{"line", "plane", "solid"};
  return kNames[kind];
}

std::string_view to_string(JointKind kind) { return kind == JointKind::hinge ? "hinge" : "ball"; }

std::string_view to_string(SkinVerdict verdict) {
  static constexpr EnumNames<SkinVerdict::cannot_tell> kNames{"untested", "follows the posture", "none seen",
                                                              "cannot be told"};
  return kNames[verdict];
}

std::string_view to_string(CentreState state) {
  static constexpr EnumNames<CentreState::determined> kNames{"undetermined", "ambiguous", "bridged",
                                                             "determined"};
  return kNames[state];
}

Status SegmentLayout::validate(std::int64_t markers) const {
  const auto bad = [](std::string text) { return fail(Code::bad_input, "segments: " + std::move(text)); };
  std::set<std::string_view> names;
  std::set<int> taken;
  for (const Segment& s : segments) {
    if (s.name.empty() || !names.insert(s.name).second)
      return bad(fmt::format("name '{}' is empty or used twice", s.name));
    if (s.markers.empty()) return bad(fmt::format("'{}' has no markers", s.name));
    for (const int m : s.markers) {
      if (m < 0 || m >= markers) return bad(fmt::format("'{}' names marker {} of {}", s.name, m, markers));
      if (!taken.insert(m).second) return bad(fmt::format("marker {} is on '{}' and on another", m, s.name));
    }
  }
  names.clear();
  const int S = static_cast<int>(segments.size());
  std::vector<int> root(segments.size());
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](int s) {
    while (root[static_cast<std::size_t>(s)] != s) s = root[static_cast<std::size_t>(s)];
    return s;
  };
  for (const Joint& j : joints) {
    if (j.name.empty() || !names.insert(j.name).second)
      return bad(fmt::format("joint name '{}' is empty or used twice", j.name));
    if (j.parent < 0 || j.parent >= S || j.child < 0 || j.child >= S)
      return bad(fmt::format("joint '{}' joins segments {} and {} of {}", j.name, j.parent, j.child, S));
    const int a = root_of(j.parent), b = root_of(j.child);
    if (a == b) return bad(fmt::format("joint '{}' closes a circle; a tree was expected", j.name));
    root[static_cast<std::size_t>(b)] = a;
  }
  for (const End& e : ends) {
    if (e.name.empty() || !names.insert(e.name).second)
      return bad(fmt::format("name '{}' of an end is empty or used twice", e.name));
    const auto of = std::ranges::find(segments, e.segment, &Segment::name);
    if (of == segments.end())
      return bad(fmt::format("'{}' is on '{}', which is no segment", e.name, e.segment));
    if (!e.stays() && std::ranges::find(of->markers, e.marker) == of->markers.end())
      return bad(fmt::format("the marker of '{}' is not on '{}'", e.name, e.segment));
  }
  return {};
}

Eigen::Matrix3d Skeleton::centre_covariance(std::int64_t frame, std::int64_t joint) const {
  return math::unpack_symmetric3(covariance.data() + 6 * index(frame, joint));
}

void Skeleton::allocate_centres() {
  const std::size_t n = static_cast<std::size_t>(std::max<std::int64_t>(0, frames())) * joints.size();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  centre_in_world.assign(3 * n, kNone);
  covariance.assign(6 * n, kNone);
  state.assign(n, CentreState::undetermined);
}

Status Skeleton::validate() const {
  const auto bad = [](std::string text) { return fail(Code::bad_input, "skeleton: " + std::move(text)); };
  std::set<std::string_view> names;
  for (const SkeletonSegment& s : segments) {
    if (s.name.empty() || !names.insert(s.name).second)
      return bad(fmt::format("segment name '{}' is empty or used twice", s.name));
    if (s.x_in_segment.cols() != static_cast<Eigen::Index>(s.markers.size()))
      return bad(fmt::format("segment '{}' has {} markers but {} positions", s.name, s.markers.size(),
                             s.x_in_segment.cols()));
    for (const int m : s.markers)
      if (m < 0 || m >= static_cast<int>(markers.size()))
        return bad(fmt::format("segment '{}' names marker {} of {}", s.name, m, markers.size()));
  }
  names.clear();
  const int S = static_cast<int>(segments.size()), J = static_cast<int>(joints.size());
  for (const SkeletonJoint& j : joints) {
    if (j.name.empty() || !names.insert(j.name).second)
      return bad(fmt::format("joint name '{}' is empty or used twice", j.name));
    if (j.parent_segment < 0 || j.parent_segment >= S || j.child_segment < 0 || j.child_segment >= S ||
        j.parent_segment == j.child_segment)
      return bad(fmt::format("joint '{}' joins segments {} and {} of {}", j.name, j.parent_segment,
                             j.child_segment, S));
  }
  for (const SkeletonLength& l : lengths)
    if (l.joint_a < 0 || l.joint_a >= J || l.joint_b < 0 || l.joint_b >= J)
      return bad(
          fmt::format("length '{}' lies between joints {} and {} of {}", l.name, l.joint_a, l.joint_b, J));
  const auto F = static_cast<std::size_t>(std::max<std::int64_t>(0, frames()));
  for (const SkeletonEnd& e : ends) {
    if (e.name.empty() || !names.insert(e.name).second)
      return bad(fmt::format("name '{}' of an end is empty or used twice", e.name));
    if (e.segment < 0 || e.segment >= S || e.joint < -1 || e.joint >= J)
      return bad(
          fmt::format("end '{}' is on segment {} of {}, joint {} of {}", e.name, e.segment, S, e.joint, J));
    if (e.state.size() != F || e.centre_in_world.size() != 3 * F || e.covariance_in_world.size() != 6 * F)
      return bad(fmt::format("end '{}' has {} frames of {}", e.name, e.state.size(), F));
  }
  const std::size_t n = static_cast<std::size_t>(std::max<std::int64_t>(0, frames())) * joints.size();
  if (state.size() != n || centre_in_world.size() != 3 * n || covariance.size() != 6 * n)
    return bad(fmt::format("{} states, {} coordinates, {} covariances; need {}, {}, {}", state.size(),
                           centre_in_world.size(), covariance.size(), n, 3 * n, 6 * n));
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Map<const Eigen::Vector3d> c(centre_in_world.data() + 3 * i);
    if (state[i] == CentreState::undetermined ? !c.array().isNaN().all() : !c.allFinite())
      return bad(fmt::format("the centre of joint '{}' in frame {} has the state {} and is ({}, {}, {})",
                             joints[i % joints.size()].name, i / joints.size(), to_string(state[i]), c.x(),
                             c.y(), c.z()));
  }
  return {};
}

}  // namespace kinemark::data
