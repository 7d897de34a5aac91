// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/array.h"

namespace kinemark::skeleton::articulated {

/// What one frame says of a point: its position, and with how much information (1/m^2, rank 0 to 3).
struct PathPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// True where the information holds all three coordinates.
[[nodiscard]] bool holds_a_position(const PathPoint& point);

/// A point's path through time.
struct SmoothedPath {
  std::vector<Eigen::Vector3d> position;  ///< F, m; NaN where the path is not known
  Array<double> covariance;               ///< F x 6 (xx xy xz yy yz zz), m^2; NaN likewise

  [[nodiscard]] bool known(std::size_t frame) const { return position[frame].allFinite(); }
  [[nodiscard]] Eigen::Matrix3d covariance_at(std::size_t frame) const;
};

/// Position of a point under jerk that is white noise of density `white_jerk` (m^2/s^5), given all frames,
/// which may be of any rank. Stretches of more than a second in which no frame holds a position are left
/// unknown but for their first and last half second. O(F) time. The smoother is math::smooth_wiener() of
/// order 3.
[[nodiscard]] SmoothedPath smooth_path(std::span<const PathPoint> points, double rate_hz, double white_jerk);

/// Log likelihood of the positions given such a path, up to a constant that the points alone fix.
[[nodiscard]] double calc_path_likelihood(std::span<const PathPoint> points, double rate_hz,
                                          double white_jerk);

/// How fast a point moves.
struct PathPrior {
  double white_jerk = 0.0;  ///< m^2/s^5, the likeliest
  bool follows = false;     ///< the frames follow each other: such a path explains them better than none
};

/// The likeliest density of jerk, from up to `max_frames` frames in four windows. `follows` compares with
/// positions that are independent from frame to frame.
[[nodiscard]] PathPrior find_path_prior(std::span<const PathPoint> points, double rate_hz,
                                        std::int64_t max_frames = 2000);

}  // namespace kinemark::skeleton::articulated
