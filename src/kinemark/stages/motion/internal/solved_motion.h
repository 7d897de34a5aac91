// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From solved states to the coordinates of a motion, and what follows from them.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Coordinates of all states (one column per frame), Euler angles continuous from frame to frame.
void fill_coordinates(const Problem& problem, const Eigen::MatrixXd& states, data::JointMotion& motion);

/// A finding for each coordinate that is at its limit in more than a tenth of the frames: model and subject
/// disagree.
void note_limits(const Problem& problem, const data::JointMotion& motion, data::MarkerFit& fit);

/// Converged frames with a coordinate that is not determined become underdetermined.
void flag_underdetermined(data::JointMotion& motion);

}  // namespace kinemark::motion::internal
