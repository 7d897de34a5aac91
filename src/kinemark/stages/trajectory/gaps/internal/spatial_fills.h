// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/fills.h"
#include "kinemark/stages/trajectory/gaps/internal/recording.h"

namespace kinemark::trajectory::internal {

/// Rotation and translation that map the reference shape onto the markers of one frame: x_in_world = R
/// x_in_local + c.
struct LocalPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
};

/// A local frame attached to a few markers.
///
/// Three or more markers that are not on a line give rotation and translation (weighted least squares,
/// math::fit_rotation()); fewer give a translation only; none the world frame.
class LocalFrame {
 public:
  /// @param sd_m  Of the distance to the target, per marker; weights are 1 / (sd^2 + (1 mm)^2).
  /// @param shape_frames  Frames where all markers are usable; their mean is the reference shape.
  LocalFrame(const Recording& recording, std::span<const Index> markers, std::span<const double> sd_m,
             std::span<const Index> shape_frames);

  /// All markers are usable in the frame.
  [[nodiscard]] LocalPose at(Index frame) const;
  [[nodiscard]] bool has_rotation() const { return has_rotation_; }

 private:
  [[nodiscard]] Eigen::Vector3d centre(Index frame) const;

  const Recording* recording_;
  std::vector<Index> markers_;
  Eigen::VectorXd weight_;  // sums to 1
  Eigen::Matrix3Xd shape_;  // about its centre
  bool has_rotation_ = false;
};

/// Append the candidates that use other markers. The problem has windows and predictors.
void spatial_fills(const Recording& recording, const GapProblem& problem, GapMethod method, WalkCache& cache,
                   std::vector<Fill>& fills);

}  // namespace kinemark::trajectory::internal
