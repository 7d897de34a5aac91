// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

/// Rotation of a segment against another over the frames in which both have a pose.
struct RelativeMotion {
  std::vector<std::int64_t> frames;  ///< in which both poses are known
  double range_rad =
      0.0;  ///< largest rotation between two of these frames (a lower bound, nearly always attained)
  Eigen::Vector3d sd_rad =
      Eigen::Vector3d::Zero();  ///< SD of the rotation from the mean, about its axes, largest first
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, in the child's mean pose
  Eigen::Matrix3d mean = Eigen::Matrix3d::Identity();  ///< rotation, from the child's axes to the parent's

  /// Hinge if the second largest SD is at most a quarter of the largest, or at most what noise of the poses
  /// (rad, per axis) alone would produce.
  [[nodiscard]] data::JointKind kind(double noise_rad) const;
};

/// Over the frames in which both poses are known. O(F).
[[nodiscard]] RelativeMotion measure_motion(const SegmentPoses& parent, const SegmentPoses& child);

}  // namespace kinemark::skeleton
