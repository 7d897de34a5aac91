// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Levels that the body and its movement allow, and what levels leave to one another.
#pragma once

#include <vector>

#include "kinemark/stages/motion/control/internal/followed_run.h"
#include "kinemark/stages/motion/control/internal/plan.h"
#include "kinemark/stages/motion/control/track.h"

namespace kinemark::motion::internal {

/// Levels from the poses of a body that followed all markers alike.
///
/// In each pose, one every half second, the rows of a marker are its Jacobian in the metric of the kinetic
/// energy, J L^-T. Greedy: next comes the marker whose three rows, less what those chosen so far have of
/// them, keep the largest smallest singular value in its worst pose; the choice ends below 0.1 kg^-1/2. Level
/// 1 has those of them whose rows make an angle with those of every other one there (cosine 0.9 at most in
/// every pose), level 2 the others, the lowest level the markers that are left. Only markers that are seen
/// nearly always are chosen.
///
/// Error: no marker has three directions of its own.
[[nodiscard]] Result<LevelProposal> propose_levels(const Plan& plan, const Track& track);

/// Rows of each level as asked for, and the fewest directions that those above leave to it in the poses
/// (`directions_left`).
void count_directions(const Plan& plan, const Track& track, std::vector<LevelAccount>& levels);

}  // namespace kinemark::motion::internal
