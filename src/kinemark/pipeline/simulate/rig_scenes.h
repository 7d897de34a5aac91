// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Scenes before the rig as the program stages them: the same for a recording and for a device.
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::pipeline {

/// A scene, its default duration, and the stream of its noise.
struct StagedScene {
  simulation::RigScene scene;
  double duration_s = 0.0;
  std::uint64_t stream = 0;
};

/// @param pose  0 to 9; Code::usage for others
[[nodiscard]] Result<StagedScene> stage_tree(int pose);
/// The two orientations of the study have streams of their own. Code::usage where its turn is no number.
[[nodiscard]] Result<StagedScene> stage_wheel(const simulation::WheelOptions& wheel);
[[nodiscard]] StagedScene stage_sign();

}  // namespace kinemark::pipeline
