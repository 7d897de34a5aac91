// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/stages/motion/internal/judged_frames.h"

namespace kinemark::motion::internal {

/// Say what was left out, and what is doubtful: findings of the fit, its count of frames left out for each
/// marker, and the state of every sample of the motion.
void add_sample_findings(const Problem& problem, const JudgedFrames& judged,
                         const data::Trajectories& markers, data::JointMotion& motion, data::MarkerFit& fit);

}  // namespace kinemark::motion::internal
