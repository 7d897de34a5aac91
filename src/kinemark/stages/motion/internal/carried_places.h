// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/step_scale.h"

namespace kinemark::motion::internal {

/// Put every sample that was left out (state rejected) where the frames beside have its marker on the body,
/// so that the customary pull of a marker that never fits exactly does not vanish for some frames and the
/// pose does not jump. The body's pose comes from all other markers, seen from their places in the frames
/// beside. Samples whose places are not known beside stay away.
///
/// @param concerned  F, not 0 for the frames with such samples; their states become the poses found
/// @return           the recording with those samples, in the state model_filled
[[nodiscard]] data::Trajectories carry_places(const Problem& problem, const data::Trajectories& kept,
                                              const std::vector<std::uint8_t>& concerned,
                                              const StepScale& scale, SolvedFrames& solved);

}  // namespace kinemark::motion::internal
