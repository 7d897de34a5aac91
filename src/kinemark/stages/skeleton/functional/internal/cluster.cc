// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/cluster.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/functional/internal/rigid_shape.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kSeen = 0.8;  ///< share of the frames that must show a marker
constexpr std::size_t kLeastMarkers = 3;
constexpr double kLeastInertia_m2 = 1e-7;  ///< 0.3 mm about a line: keeps the inverse of a flat shape finite

Cluster cluster_of(const Samples& samples, const SegmentPoses& poses, const RelativeMotion& motion) {
  Cluster out;
  std::vector<std::pair<std::int64_t, Eigen::Index>> seen;
  for (Eigen::Index k = 0; k < poses.x_in_segment.cols(); ++k) {
    if (!poses.x_in_segment.col(k).allFinite()) continue;
    const auto count =
        std::ranges::count_if(motion.frames, [&](auto f) { return samples.seen(f, poses.markers[at(k)]); });
    seen.emplace_back(-count, k);
  }
  std::ranges::sort(seen);
  for (const auto& [count, k] : seen)
    if (out.columns.size() < kLeastMarkers ||
        static_cast<double>(-count) >= kSeen * static_cast<double>(motion.frames.size()))
      out.columns.push_back(k);
  std::ranges::sort(out.columns);
  for (const auto k : out.columns) out.mean += poses.x_in_segment.col(k);
  const auto n = static_cast<double>(std::max<std::size_t>(out.columns.size(), 1));
  out.mean /= n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto k : out.columns) {
    const Eigen::Vector3d arm = poses.x_in_segment.col(k) - out.mean;
    scatter += arm * arm.transpose();
  }
  out.radius_m = std::sqrt(scatter.trace() / n);
  out.inverse_inertia = (inertia(scatter) + kLeastInertia_m2 * Eigen::Matrix3d::Identity()).inverse();
  return out;
}

}  // namespace

ClusterPair find_clusters(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                          const RelativeMotion& motion) {
  ClusterPair out{.parent = cluster_of(samples, parent, motion), .child = cluster_of(samples, child, motion)};
  const auto shows = [&](std::int64_t f, const SegmentPoses& poses, const Cluster& cluster) {
    return std::ranges::all_of(cluster.columns,
                               [&](auto k) { return samples.seen(f, poses.markers[at(k)]); });
  };
  for (const std::int64_t f : motion.frames)
    if (shows(f, parent, out.parent) && shows(f, child, out.child)) out.frames.push_back(f);
  return out;
}

Eigen::MatrixXd deformation(const Samples& samples, const SegmentPoses& poses, const Cluster& cluster,
                            const std::vector<std::int64_t>& frames) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(frames.size()),
                      3 * static_cast<Eigen::Index>(cluster.columns.size()));
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (std::size_t k = 0; k < cluster.columns.size(); ++k) {
      const auto column = cluster.columns[k];
      out.row(static_cast<Eigen::Index>(i)).segment<3>(3 * static_cast<Eigen::Index>(k)) =
          (poses.to_segment(frames[i], samples.x(frames[i], poses.markers[at(column)])) -
           poses.x_in_segment.col(column))
              .transpose();
    }
  if (out.rows() > 0) out.rowwise() -= out.colwise().mean().eval();
  return out;
}

}  // namespace kinemark::skeleton::internal
