// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/step_scale.h"

namespace kinemark::motion::internal {

/// Replace every sample that was left out (state rejected) by the position that its marker has on the body in
/// the frames beside. Without it the constant part of a marker's residual would vanish for some frames, and
/// the pose would jump. The body's pose comes from all other markers and their positions on the body in the
/// frames beside. A sample whose position there is not known stays missing.
///
/// @param concerned  F, not 0 for the frames with such samples; their states become the poses found
/// @return           the recording with those samples, in the state model_filled
[[nodiscard]] data::Trajectories fill_rejected(const Problem& problem, const data::Trajectories& kept,
                                               const std::vector<std::uint8_t>& concerned, StepScale& scale,
                                               SolvedFrames& solved);

}  // namespace kinemark::motion::internal
