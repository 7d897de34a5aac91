// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/relative_motion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kinemark/math/euler.h"
#include "kinemark/math/rotation_fit.h"

namespace kinemark::skeleton {
namespace {

constexpr double kHingeRatio = 0.25;
constexpr double kHingeNoise = 3.0;  ///< rotations below so many SDs of the noise count as none

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return math::log_so3(a.transpose() * b).norm();
}

}  // namespace

data::JointKind RelativeMotion::kind(double noise_rad) const {
  const double bound = std::max(kHingeRatio * sd_rad(0), kHingeNoise * noise_rad);
  return sd_rad(0) > bound && sd_rad(1) <= bound ? data::JointKind::hinge : data::JointKind::ball;
}

RelativeMotion measure_motion(const SegmentPoses& parent, const SegmentPoses& child) {
  RelativeMotion motion;
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t f = 0; f < parent.known.size(); ++f) {
    if (!parent.known[f] || !child.known[f]) continue;
    motion.frames.push_back(static_cast<std::int64_t>(f));
    rotations.emplace_back(parent.world_from_segment[f].transpose() * child.world_from_segment[f]);
    sum += rotations.back();
  }
  if (rotations.empty()) return motion;
  const Eigen::Matrix3d mean = math::fit_rotation(sum).rotation;
  motion.mean = mean;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& rotation : rotations) {
    const Eigen::Vector3d v = math::log_so3(mean.transpose() * rotation);
    squares += v * v.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / static_cast<double>(rotations.size()));
  motion.sd_rad = solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  motion.axes = solver.eigenvectors().rowwise().reverse();
  // The frame farthest from the mean, the one farthest from that, and once more.
  Eigen::Matrix3d from = mean;
  for (int step = 0; step < 4; ++step) {
    const auto far = std::ranges::max_element(
        rotations, {}, [&](const Eigen::Matrix3d& t) { return angle_between(from, t); });
    if (step > 0) motion.range_rad = std::max(motion.range_rad, angle_between(from, *far));
    from = *far;
  }
  return motion;
}

}  // namespace kinemark::skeleton
