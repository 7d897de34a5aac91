// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

/// How a segment turns against another over the frames in which both have a pose.
struct RelativeMotion {
  std::vector<std::int64_t> frames;  ///< in which both poses are known
  double range_rad = 0.0;  ///< largest turn between two of these frames (a lower bound, nearly always met)
  Eigen::Vector3d sd_rad =
      Eigen::Vector3d::Zero();  ///< of the turn from the mean, about its axes, largest first
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, in the child's mean pose

  /// A hinge turns about its axis alone: the next largest SD is no more than a quarter of the largest, or no
  /// more than what noise of the poses (rad, per axis) makes of none.
  [[nodiscard]] data::JointKind kind(double noise_rad) const;
};

/// Over the frames in which both poses are known. O(F).
[[nodiscard]] RelativeMotion measure_motion(const SegmentPoses& parent, const SegmentPoses& child);

/// Rotation vector of a rotation, length 0 to pi.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

}  // namespace kinemark::skeleton
