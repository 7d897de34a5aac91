// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/masses.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kinemark/stages/motion/scaling/internal/segments.h"

namespace kinemark::motion {
namespace {

struct Share {
  const char* segment;
  bool paired;
  double fraction;     // of the body mass, one side
  double mass_centre;  // of the way from the joint above to the joint below; 0: left alone
  const char* inward;  // takes the share where the segment is missing
};

// From the ends inwards, so that a missing chain passes its shares on. Pelvis and trunk substitute each
// other.
constexpr Share kShares[] = {
    {"hand", true, 0.006, 0.0, "forearm"},      {"forearm", true, 0.016, 0.0, "upper arm"},
    {"upper arm", true, 0.028, 0.436, "trunk"}, {"foot", true, 0.0145, 0.0, "shank"},
    {"shank", true, 0.0465, 0.433, "thigh"},    {"thigh", true, 0.100, 0.433, "pelvis"},
    {"head", false, 0.081, 0.0, "trunk"},       {"trunk", false, 0.355, 0.0, "pelvis"},
    {"pelvis", false, 0.142, 0.0, "trunk"}};

/// "thigh_r" for paired segments, "trunk" for others; empty for bodies that are no segment.
std::string key_of(const std::string& body) {
  const auto [stem, side] = internal::split_side(body);
  const std::string segment = internal::segment_of(stem);
  for (const auto& share : kShares)
    if (segment == share.segment) {
      if (share.paired && side.empty()) return {};  // side unknown: it keeps its mass
      return share.paired ? segment + side : segment;
    }
  return {};
}

bool is_paired(const std::string& segment) {
  for (const auto& share : kShares)
    if (segment == share.segment) return share.paired;
  return false;
}

/// Mass centre on the line from the body's own joint to the one below, where there is exactly one.
void set_mass_centre(data::ModelDescription& model, int body, double share) {
  const data::JointDescription *own = nullptr, *below = nullptr;
  int count = 0;
  for (const auto& joint : model.joints) {
    if (joint.child_body_idx == body) own = &joint;
    if (joint.parent_body_idx != body) continue;
    below = &joint;
    ++count;
  }
  if (own == nullptr || count != 1) return;
  const Eigen::Vector3d start = own->child_from_joint.translation;
  model.bodies[static_cast<std::size_t>(body)].com_in_body =
      start + share * (below->parent_from_joint.translation - start);
}

}  // namespace

Status distribute_mass(data::ModelDescription& model, double mass_kg) {
  std::map<std::string, std::vector<int>> bodies;
  double other = 0.0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::string key = key_of(model.bodies[b].name);
    if (key.empty())
      other += model.bodies[b].mass;
    else
      bodies[key].push_back(static_cast<int>(b));
  }
  if (!bodies.contains("pelvis") && !bodies.contains("trunk"))
    return fail(Code::bad_input,
                fmt::format("model '{}' has neither a pelvis nor a trunk (torso, thorax) whose "
                            "share of the body mass is known",
                            model.name));
  if (!(mass_kg > other) || !std::isfinite(mass_kg))
    return fail(Code::usage,
                fmt::format("a subject's mass of {} kg; need more than the {} kg of bodies that are "
                            "no segment",
                            mass_kg, other));
  std::map<std::string, double> fraction;
  for (const auto& share : kShares)
    for (const std::string side : {"_r", "_l"}) {
      if (!share.paired && side == "_l") continue;
      const std::string key = share.paired ? share.segment + side : share.segment;
      const double mine = fraction[key] + share.fraction;
      fraction[key] = mine;
      if (bodies.contains(key)) continue;
      fraction.erase(key);
      fraction[is_paired(share.inward) ? share.inward + side : share.inward] += mine;
    }

  for (const auto& [key, members] : bodies) {
    double before = 0.0;
    for (const int b : members) before += model.bodies[static_cast<std::size_t>(b)].mass;
    const double mass = fraction[key] * (mass_kg - other);
    for (const int b : members) {
      auto& body = model.bodies[static_cast<std::size_t>(b)];
      if (before > 0.0) {
        body.inertia_about_com *= mass / before;
        body.mass *= mass / before;
      } else {
        body.mass = mass / static_cast<double>(members.size());
      }
      for (const auto& share : kShares)
        if (share.mass_centre > 0.0 && key.starts_with(share.segment) && members.size() == 1)
          set_mass_centre(model, b, share.mass_centre);
    }
  }
  return {};
}

}  // namespace kinemark::motion
