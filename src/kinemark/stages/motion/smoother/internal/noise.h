// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Marker noise, split into what changes from frame to frame and what stays.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/smoother/sightings.h"

namespace kinemark::motion::internal {

/// Variances per axis, m^2. White noise has the second differences of white noise; the rest of a marker's
/// residual variance, beyond what chance explains, is slow.
struct NoiseSplit {
  Eigen::VectorXd white, slow;     ///< M, parts of the marker's own variance
  Eigen::VectorXd common_slow;     ///< per body, part that its markers share
  std::vector<MarkerTrust> trust;  ///< M, for the smoother: white noise, evened out between markers
  bool any_slow = false;
};

/// Least squares has no robust loss: one wild sample makes its own marker look bad and the others of the
/// segment good, in all frames. Frames with a residual beyond `bend_sd` of what most frames of that marker
/// show lose their residuals in start.motion, and the noise in start.fit is estimated anew without them;
/// when they are more than a tenth of all they are no outliers, and nothing changes.
void leave_out_outliers(const Problem& problem, const data::Trajectories& markers, double bend_sd,
                        int threads, IkResult& start);

/// From the least-squares solution with its estimated (or given) noise.
[[nodiscard]] NoiseSplit split_noise(const Problem& problem, const IkResult& start, double given_sd_m,
                                     double bend_sd);

}  // namespace kinemark::motion::internal
