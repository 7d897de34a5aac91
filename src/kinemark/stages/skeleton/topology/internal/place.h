// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A joint as a point that two clusters of markers share, and its path in space: what rival segmentations are
// compared by.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// Whether a cluster has a pose: three markers or more, whose second singular value over the root of their
/// number is 8 times `noise_m`, so that the turn about their best line is known.
[[nodiscard]] bool is_wide(const Eigen::Matrix3Xd& x_in_segment, double noise_m);

/// The point that two clusters share.
struct Place {
  std::vector<int> a, b;                               ///< markers of either cluster
  double gap_m = 0.0;                                  ///< distance of the places that the two give it, RMS
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  ///< SD of the turn about its axes, largest first
  bool hinge = false;                                  ///< turns about one axis: nothing is known along it
  double reach_a_m = 0.0, reach_b_m = 0.0;             ///< distance from the mean of either's markers
  Eigen::Matrix3Xd path;  ///< one column a frame, m, world; NaN where a pose is unknown
  Eigen::Matrix3Xd axis;  ///< of a hinge, unit length; empty for a ball

  /// Gap for each radian of turn: small values favour the joint.
  [[nodiscard]] double cost() const { return gap_m / turn_rad[0]; }
};

/// SCoRE of two clusters; nothing where fewer than 20 frames show both poses or nothing turns.
[[nodiscard]] std::optional<Place> find_place(const SegmentPoses& a, const SegmentPoses& b);

/// Median distance of two paths over the frames that both have, across the axis of the first where it is a
/// hinge; infinite without such frames.
[[nodiscard]] double distance(const Place& from, const Place& to);

/// The same poses in the frames from `first` to before `end` alone.
[[nodiscard]] SegmentPoses within(const SegmentPoses& poses, std::size_t first, std::size_t end);

/// Poses of clusters, each found once.
class PoseStore {
 public:
  explicit PoseStore(const Samples& samples) : samples_(samples) {}
  [[nodiscard]] const SegmentPoses& of(const std::vector<int>& markers);

 private:
  const Samples& samples_;
  std::map<std::vector<int>, SegmentPoses> poses_;
};

}  // namespace kinemark::skeleton::internal
