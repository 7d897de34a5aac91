// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/rig_scenes.h"

#include <fmt/core.h>

#include <cmath>

namespace kinemark::pipeline {

Result<StagedScene> stage_tree(int pose) {
  const auto& poses = simulation::tree_test_poses();
  if (pose < 0 || pose >= static_cast<int>(poses.size()))
    return fail(Code::usage, fmt::format("tree pose {}; there are 0 to {}", pose, poses.size() - 1));
  return StagedScene{simulation::still_tree(poses[static_cast<std::size_t>(pose)]), 1.0,
                     300 + static_cast<std::uint64_t>(pose)};
}

Result<StagedScene> stage_wheel(const simulation::WheelOptions& wheel) {
  if (!std::isfinite(wheel.rotation_deg))
    return fail(Code::usage, fmt::format("a wheel turned by {} degrees; need a number", wheel.rotation_deg));
  return StagedScene{simulation::rotating_wheel(wheel), 2.2, wheel.rotation_deg > 20.0 ? 401U : 400U};
}

StagedScene stage_sign() { return {simulation::signing_arm(), 4.0, 420}; }

}  // namespace kinemark::pipeline
