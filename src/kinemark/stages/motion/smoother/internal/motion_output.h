// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From solved states and their covariance to joint motion.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/smoother/internal/slow_errors.h"
#include "kinemark/stages/motion/smoother/rates.h"

namespace kinemark::motion::internal {

/// Fill q (angles of free joints continuous), qd and qdd from the states.
void fill_coordinates(const model::Model& model, const Eigen::MatrixXd& states, data::JointMotion& motion);

/// Covariance of each coordinate, its rate and its acceleration (6 x n: the upper triangle by rows) in one of
/// three neighbouring frames (`index` 0, 1, 2) from their joint covariance (3 nv x 3 nv). E: dq/dv.
void coordinate_covariances(const Eigen::MatrixXd& joint, int index, double rate_hz, const Eigen::MatrixXd& E,
                            Eigen::MatrixXd& out);

}  // namespace kinemark::motion::internal
