// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/judged_frames.h"

namespace kinemark::motion::internal {

/// Say what was left out, and what is doubtful: findings of the fit, its count of frames left out for each
/// marker, and the state of every sample of the motion.
void add_sample_findings(const Problem& problem, const JudgedFrames& judged,
                         const data::Trajectories& markers, IkResult& result);

}  // namespace kinemark::motion::internal
