// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/standing_body.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "kinemark/core/index.h"
#include "kinemark/data/name_index.h"
#include "kinemark/stages/motion/foundations/internal/body_parts.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

struct PartEntry {
  BodyPart part;
  BodyPart parent;
  std::string_view name;
  Vector3d joint;     // in the parent, right side
  Vector3d turn_deg;  // SD about x, y, z
  double joint_common, joint_own, joint_by_posture;
};

const std::array<PartEntry, 10>& parts() {
  using enum BodyPart;
  static const std::array<PartEntry, 10> kParts{{
      {pelvis, pelvis, "pelvis", Vector3d::Zero(), Vector3d::Zero(), 0.0, 0.0, 0.0},
      {thigh, pelvis, "thigh", Vector3d(-0.060, -0.0765, 0.085), Vector3d(12, 15, 30), 0.012, 0.004, 0.0},
      {shank, thigh, "shank", Vector3d(0.0, -0.429, 0.0), Vector3d(4, 9, 25), 0.004, 0.003, 0.0},
      {foot, shank, "foot", Vector3d(0.0, -0.4305, 0.0), Vector3d(9, 9, 15), 0.004, 0.003, 0.0},
      {trunk, pelvis, "trunk", Vector3d(-0.070, 0.081, 0.0), Vector3d(10, 12, 20), 0.020, 0.0, 0.025},
      {head, trunk, "head", Vector3d(0.000, 0.410, 0.0), Vector3d(15, 30, 25), 0.020, 0.0, 0.015},
      {shoulder, trunk, "shoulder", Vector3d(0.055, 0.340, 0.025), Vector3d(16, 14, 8), 0.015, 0.006, 0.008},
      {upper_arm, shoulder, "upper arm", Vector3d(-0.050, 0.0065, 0.1616), Vector3d(60, 60, 60), 0.015, 0.010,
       0.012},
      {forearm, upper_arm, "forearm", Vector3d(0.0, -0.329, 0.0), Vector3d(12, 60, 60), 0.006, 0.004, 0.004},
      {hand, forearm, "hand", Vector3d(0.0, -0.254, 0.0), Vector3d(25, 20, 40), 0.006, 0.004, 0.004},
  }};
  return kParts;
}

const PartEntry& entry_of(BodyPart part) { return *std::ranges::find(parts(), part, &PartEntry::part); }

bool is_middle(BodyPart part) {
  return part == BodyPart::pelvis || part == BodyPart::trunk || part == BodyPart::head;
}

Vector3d mirrored(const Vector3d& x) { return {x.x(), x.y(), -x.z()}; }

/// Adds segments as markers ask for them.
class Builder {
 public:
  int segment(BodyPart part, Side side) {
    if (is_middle(part)) side = Side::middle;
    for (std::size_t s = 0; s < made_.size(); ++s)
      if (made_[s] == std::pair(part, side)) return static_cast<int>(s);
    const PartEntry& entry = entry_of(part);
    StandingBody::Segment out;
    if (part != BodyPart::pelvis) out.parent = segment(entry.parent, side);
    const std::string words = side == Side::left ? "left " : side == Side::right ? "right " : "";
    out.name = words + std::string(entry.name);
    out.side = side;
    out.joint_in_parent = side == Side::left ? mirrored(entry.joint) : entry.joint;
    out.turn_sd = internal::kDegree * entry.turn_deg;
    out.joint_common_sd = entry.joint_common;
    out.joint_own_sd = entry.joint_own;
    out.joint_by_posture = entry.joint_by_posture;
    out.size = internal::add_size(body, std::string(entry.name), side);
    if (part == BodyPart::pelvis || part == BodyPart::trunk)
      out.width = internal::add_size(body, std::string(entry.name) + " width", side);
    if (side != Side::middle) {
      const Side other = side == Side::left ? Side::right : Side::left;
      for (std::size_t s = 0; s < made_.size(); ++s)
        if (made_[s] == std::pair(part, other)) {
          out.mirror = static_cast<int>(s);
          body.segments[s].mirror = static_cast<int>(made_.size());
        }
    }
    made_.emplace_back(part, side);
    body.segments.push_back(std::move(out));
    return static_cast<int>(made_.size()) - 1;
  }

  StandingBody body;

 private:
  std::vector<std::pair<BodyPart, Side>> made_;
};

/// The names of the person with most landmarks where a landmark is there of two ("Ann:LASI", "Bob:LASI");
/// else all names.
std::vector<std::string> names_of_one(const std::vector<std::string>& names) {
  std::map<std::string_view, std::int64_t> landmarks_of;  // by the prefix
  std::set<std::string_view> seen;
  bool several = false;
  for (const std::string_view name : names) {
    if (!landmark_of(name)) continue;
    const auto plain = data::without_prefix(name);
    ++landmarks_of[name.substr(0, name.size() - plain.size())];
    several = !seen.insert(plain).second || several;
  }
  if (!several) return names;
  const auto most = std::ranges::max_element(landmarks_of, {}, [](const auto& one) { return one.second; });
  std::vector<std::string> out;
  for (const auto& name : names)
    if (name.size() - data::without_prefix(name).size() == most->first.size() &&
        name.starts_with(most->first))
      out.push_back(name);
  return out;
}

}  // namespace

namespace internal {

/// Partners carry the same stem on the other side.
void pair_markers(StandingBody& body) {
  std::vector<SidedName> names;
  for (const auto& marker : body.markers) names.push_back(split_marker_name(marker.name));
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      if (names[i].stem != names[j].stem || names[i].side == names[j].side) continue;
      if (names[i].side == Side::middle || names[j].side == Side::middle) continue;
      if (body.markers[i].mirror >= 0 || body.markers[j].mirror >= 0) continue;
      body.markers[i].mirror = static_cast<int>(j);
      body.markers[j].mirror = static_cast<int>(i);
    }
}

int add_size(StandingBody& body, const std::string& name, Side side) {
  const auto full = [&](Side s) { return s == Side::middle ? name : name + (s == Side::left ? " l" : " r"); };
  const auto find = [&](const std::string& wanted) {
    const auto at = std::ranges::find(body.sizes, wanted, &StandingBody::Size::name);
    return at == body.sizes.end() ? -1 : static_cast<int>(at - body.sizes.begin());
  };
  if (const int found = find(full(side)); found >= 0) return found;
  StandingBody::Size out;
  out.name = full(side);
  if (name == "pelvis width" || name == "foot" || name == "head" || name == "hand") out.common_sd = 0.09;
  if (side != Side::middle) {
    out.mirror = find(full(side == Side::left ? Side::right : Side::left));
    if (out.mirror >= 0) body.sizes[at(out.mirror)].mirror = static_cast<int>(body.sizes.size());
  }
  body.sizes.push_back(std::move(out));
  return static_cast<int>(body.sizes.size()) - 1;
}

}  // namespace internal

StandingBody body_of_names(const std::vector<std::string>& names) {
  Builder builder;
  builder.segment(BodyPart::pelvis, Side::middle);
  for (const auto& name : names_of_one(names)) {
    const auto landmark = landmark_of(name);
    if (!landmark) continue;
    StandingBody::Marker marker;
    marker.name = name;
    marker.segment = builder.segment(landmark->part, landmark->side);
    marker.x_in_segment = landmark->side == Side::left ? mirrored(landmark->x_in_part) : landmark->x_in_part;
    marker.spread = landmark->spread;
    builder.body.markers.push_back(std::move(marker));
  }
  internal::pair_markers(builder.body);
  return std::move(builder.body);
}

}  // namespace kinemark::motion
