// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/pose_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "kinemark/core/index.h"

namespace kinemark::io {

math::SE3 PoseTree::pose_in_parent(std::int64_t frame, std::size_t body) const {
  const int parent = bodies[body].parent;
  return parent < 0 ? pose(frame, body) : pose(frame, at(parent)).inverse() * pose(frame, body);
}

bool PoseTree::moves_in_parent(std::size_t body, double tolerance_m) const {
  const Eigen::Vector3d first = pose_in_parent(0, body).translation;
  for (std::int64_t f = 1; f < time.frames; ++f)
    if ((pose_in_parent(f, body).translation - first).cwiseAbs().maxCoeff() > tolerance_m) return true;
  return false;
}

std::vector<std::vector<std::size_t>> PoseTree::children() const {
  std::vector<std::vector<std::size_t>> out(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].parent >= 0) out[at(bodies[b].parent)].push_back(b);
  return out;
}

Status PoseTree::validate() const {
  const auto wrong = [](std::string what) { return fail(Code::bad_input, std::move(what)); };
  if (bodies.empty() || time.frames <= 0 || !(time.rate_hz > 0.0))
    return wrong("poses of no body, in no frame or without a rate");
  if (world_from_body.size() != bodies.size() * at(time.frames))
    return wrong(fmt::format("{} poses of {} bodies in {} frames", world_from_body.size(), bodies.size(),
                             time.frames));
  std::set<std::string> names;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].parent >= static_cast<int>(b))
      return wrong(fmt::format("body '{}' comes before its parent", bodies[b].name));
    if (bodies[b].name.empty() || !names.insert(bodies[b].name).second)
      return wrong(fmt::format("the name '{}' of a body is empty or another's too", bodies[b].name));
  }
  const auto finite = [](const math::SE3& pose) {
    return pose.rotation.allFinite() && pose.translation.allFinite();
  };
  if (!std::ranges::all_of(world_from_body, finite)) return wrong("a pose is not finite");
  return {};
}

}  // namespace kinemark::io
