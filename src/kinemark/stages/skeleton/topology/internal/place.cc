// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/place.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/score.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kWide = 8.0;
constexpr std::size_t kLeastTogether = 20;
constexpr double kPriorSd_m = 0.3;  ///< of a place about the mean of its markers
constexpr double kPriorFrames = 1e-6;
constexpr double kHinge = 0.25;  ///< second turn over the first, at most

Eigen::Vector3d mean_of(const SegmentPoses& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double n = 0.0;
  for (Eigen::Index k = 0; k < poses.x_in_segment.cols(); ++k) {
    if (!poses.x_in_segment.col(k).allFinite()) continue;
    sum += poses.x_in_segment.col(k);
    n += 1.0;
  }
  return n > 0.0 ? Eigen::Vector3d(sum / n) : sum;
}

}  // namespace

bool is_wide(const Eigen::Matrix3Xd& x_in_segment, double noise_m) {
  Eigen::Matrix3Xd x(3, 0);
  for (Eigen::Index k = 0; k < x_in_segment.cols(); ++k) {
    if (!x_in_segment.col(k).allFinite()) continue;
    x.conservativeResize(3, x.cols() + 1);
    x.col(x.cols() - 1) = x_in_segment.col(k);
  }
  if (x.cols() < 3) return false;
  x.colwise() -= x.rowwise().mean().eval();
  const Eigen::Vector3d w = Eigen::JacobiSVD<Eigen::Matrix3Xd>(x).singularValues();
  return w[1] / std::sqrt(static_cast<double>(x.cols())) > kWide * noise_m;
}

std::optional<Place> find_place(const SegmentPoses& a, const SegmentPoses& b) {
  const RelativeMotion motion = measure_motion(a, b);
  if (motion.frames.size() < kLeastTogether || !(motion.sd_rad[0] > 0.0)) return {};
  ScoreSums sums;
  for (const std::int64_t f : motion.frames) sums.add(a, b, f);
  // A weak prior about the markers' means holds what the motion leaves open.
  const Eigen::Vector3d mean_a = mean_of(a), mean_b = mean_of(b);
  const double prior = kPriorFrames * sums.frames / (kPriorSd_m * kPriorSd_m);
  Matrix6 normal = sums.normal;
  normal.diagonal().array() += prior;
  Vector6 right = sums.right;
  right.head<3>() += prior * mean_a;
  right.tail<3>() += prior * mean_b;
  const Vector6 p = normal.ldlt().solve(right);
  if (!p.allFinite()) return {};
  Place out;
  out.a = a.markers;
  out.b = b.markers;
  out.gap_m = std::sqrt(std::max(0.0, sums.cost(p)) / sums.frames);
  out.turn_rad = motion.sd_rad;
  out.hinge = motion.sd_rad[1] < kHinge * motion.sd_rad[0];
  out.reach_a_m = (p.head<3>() - mean_a).norm();
  out.reach_b_m = (p.tail<3>() - mean_b).norm();
  const auto F = static_cast<Eigen::Index>(a.known.size());
  out.path = Eigen::Matrix3Xd::Constant(3, F, kNaN);
  if (out.hinge) out.axis = out.path;
  const Eigen::Vector3d axis_in_a = motion.mean * motion.axes.col(0);
  for (const std::int64_t f : motion.frames) {
    out.path.col(f) = 0.5 * (a.to_world(f, p.head<3>()) + b.to_world(f, p.tail<3>()));
    if (out.hinge) out.axis.col(f) = a.world_from_segment[static_cast<std::size_t>(f)] * axis_in_a;
  }
  return out;
}

double distance(const Place& from, const Place& to) {
  std::vector<double> d;
  for (Eigen::Index f = 0; f < from.path.cols(); ++f) {
    Eigen::Vector3d gap = to.path.col(f) - from.path.col(f);
    if (!gap.allFinite()) continue;
    if (from.hinge) gap -= from.axis.col(f).dot(gap) * from.axis.col(f);
    d.push_back(gap.norm());
  }
  return d.empty() ? std::numeric_limits<double>::infinity() : math::quantile(d, 0.5);
}

SegmentPoses within(const SegmentPoses& poses, std::size_t first, std::size_t end) {
  SegmentPoses out = poses;
  out.known_frames = 0;
  for (std::size_t f = 0; f < out.known.size(); ++f) {
    if (f < first || f >= end) out.known[f] = 0;
    out.known_frames += out.known[f];
  }
  return out;
}

const SegmentPoses& PoseStore::of(const std::vector<int>& markers) {
  auto found = poses_.find(markers);
  if (found == poses_.end())
    found = poses_.emplace(markers, find_segment_poses(samples_, "cluster", markers)).first;
  return found->second;
}

}  // namespace kinemark::skeleton::internal
