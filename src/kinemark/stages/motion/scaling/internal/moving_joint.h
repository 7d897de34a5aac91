// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// RMS over frames (m) of the shift in its parent that a joint would need in each frame to fit best, and what
/// marker noise alone would make of it.
struct JointShift {
  double rms_m = 0.0;
  double by_noise_m = 0.0;
};

/// `body`: tree index of the joint's child. States: columns are frames.
[[nodiscard]] JointShift measure_shift(const Problem& problem, const data::Trajectories& markers,
                                       const Eigen::MatrixXd& states, int body, double noise_sd_m);

/// Sentences about shoulders that move relative to the trunk although the model fixes them.
[[nodiscard]] std::vector<std::string> recommend_joints(const Problem& problem,
                                                        const data::Trajectories& markers,
                                                        const Eigen::MatrixXd& states, double noise_sd_m);

}  // namespace kinemark::motion::internal
