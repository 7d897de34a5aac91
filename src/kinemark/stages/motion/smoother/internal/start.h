// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From a least-squares solution to the start of the smoother.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"

namespace kinemark::motion::internal {

/// States of all frames (one column each); where a coordinate is not determined it runs straight between its
/// determined neighbours (a free joint as a whole).
[[nodiscard]] Eigen::MatrixXd bridged_states(const model::Model& model, const data::JointMotion& motion);

/// Every speed's coordinate by itself. F frames.
struct SinglePaths {
  Eigen::VectorXd step_variance;  ///< of a third difference, by the likelihood of the states
  Eigen::MatrixXd
      value;  ///< speeds x F: as the states have it, where it is not determined as its smoother bridges it
  Eigen::MatrixXd doubt;  ///< speeds x F: variance of the bridge, 0 where the coordinate is determined
};

/// Frames are weighted by q_sd, beyond which, times `raised`, nothing is noise. Speeds that are never
/// determined get the usual variance of their kind.
[[nodiscard]] SinglePaths single_paths(const model::Model& model, const data::JointMotion& motion,
                                       const Eigen::MatrixXd& states, double raised);

}  // namespace kinemark::motion::internal
