// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Marker noise, split into a white and a slow part.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/smoother/observations.h"

namespace kinemark::motion::internal {

/// Variances per axis, m^2. The white part follows from second differences; the rest of a marker's residual
/// variance, beyond chance, is slow.
struct NoiseSplit {
  Eigen::VectorXd white, slow;     ///< M, parts of the marker's own variance
  Eigen::VectorXd common_slow;     ///< per body, part that its markers share
  std::vector<MarkerTrust> trust;  ///< M, for the smoother: white noise, pooled between markers
  double beyond_white = 1.0;       ///< the usual whole variance over the white part that the smoother takes
  double raised = 1.0;  ///< how often the usual noise is that estimated; above 1 where that is below 10 um
};

/// Least squares has no robust loss: one outlier raises the estimated noise of its own marker and lowers that
/// of the others on its segment, in all frames. Frames with a residual beyond `huber_sd` of what most frames
/// of that marker show lose their residuals in start.motion, and the noise in start.fit is estimated anew
/// without them; more than a tenth of all frames are not treated as outliers, and nothing changes.
void leave_out_outliers(const Problem& problem, const data::Trajectories& markers, double huber_sd,
                        int threads, IkResult& start);

/// From the least-squares solution with its estimated (or given) noise.
[[nodiscard]] NoiseSplit split_noise(const Problem& problem, const IkResult& start, double given_sd_m,
                                     double huber_sd);

}  // namespace kinemark::motion::internal
