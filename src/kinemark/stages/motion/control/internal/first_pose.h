// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/motion/control/internal/plan.h"

namespace kinemark::motion::internal {

/// Pose of the first frame by inverse kinematics on the goals (laid out like the recording), found in a frame
/// where nearly all of them are seen and tracked back from there. Locks coordinates that no goal moves, and
/// sets the rest pose of free roots to their start.
[[nodiscard]] Eigen::VectorXd find_first_pose(Plan& plan, const data::Trajectories& goals, LockMode lock);

/// The same from one frame alone (3 x M and weights), for a live stream: the coordinates that no goal moves
/// are found from this pose and random ones around it.
[[nodiscard]] Eigen::VectorXd find_first_pose(Plan& plan, const Eigen::Matrix3Xd& goal,
                                              const Eigen::VectorXd& weight, LockMode lock);

}  // namespace kinemark::motion::internal
