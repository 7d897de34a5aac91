// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The markers of two segments in frames that show all of them: what their shape does while the joint moves.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// The markers of a segment that are used for its shape.
struct Cluster {
  std::vector<Eigen::Index> columns;                          ///< M, of SegmentPoses::x_in_segment
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();             ///< of the shape, in the segment, m
  double radius_m = 0.0;                                      ///< RMS distance from the mean
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();  ///< about the mean, 1/m^2

  /// Numbers of a shape: three a marker less six of a pose.
  [[nodiscard]] double freedom() const { return 3.0 * static_cast<double>(columns.size()) - 6.0; }
};

/// Clusters of two segments and the frames that show all of either.
struct ClusterPair {
  Cluster parent, child;
  std::vector<std::int64_t> frames;
};

/// Markers seen in four fifths of the frames of `motion`, the three best at least.
[[nodiscard]] ClusterPair find_clusters(const Samples& samples, const SegmentPoses& parent,
                                        const SegmentPoses& child, const RelativeMotion& motion);

/// How far each marker is from its place in the shape, less its mean over the frames: F x 3M, m, in the
/// segment's axes.
[[nodiscard]] Eigen::MatrixXd deformation(const Samples& samples, const SegmentPoses& poses,
                                          const Cluster& cluster, const std::vector<std::int64_t>& frames);

}  // namespace kinemark::skeleton::internal
