// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/score.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/data/joint_choice.h"

namespace kinemark::skeleton {
namespace {

constexpr std::size_t kLeastFrames = 4;
constexpr std::int64_t kNoiseFrames = 200;  ///< from which the noise of the poses is estimated

struct Solution {
  Vector6 centre = Vector6::Zero();
  Vector6 axis = Vector6::Zero();  ///< two unit vectors; zero for a ball
  Vector6 open = Vector6::Zero();  ///< SD along each eigenvector due to undetermined directions, m
  Matrix6 directions = Matrix6::Identity();
  Matrix6 inverse = Matrix6::Zero();  ///< centre = inverse * right-hand side
};

/// Eigenvectors of the normal matrix, smallest first. A hinge leaves the first out.
Solution solve(const ScoreSums& sums, data::JointKind kind, double residual_variance,
               const Matrix6& pose_noise) {
  Solution s;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(sums.normal);
  s.directions = eigen.eigenvectors();
  const double prior =
      residual_variance / (data::kJointPriorSd_m * data::kJointPriorSd_m) + 1e-12 * eigen.eigenvalues()(5);
  int first = 0;
  if (kind == data::JointKind::hinge) {
    const Vector6 e = s.directions.col(0);
    s.axis << e.head<3>().normalized(), e.tail<3>().normalized();
    s.open(0) = data::kJointPriorSd_m;
    first = 1;
  }
  for (int i = first; i < 6; ++i) {
    const Vector6 e = s.directions.col(i);
    const double value = std::max(0.0, eigen.eigenvalues()(i));
    s.centre += e * (e.dot(sums.right) / (value + prior));
    s.inverse += e * e.transpose() / (value + prior);
    // Noise of the poses acts like motion: it biases the centre towards the markers by its share of the
    // eigenvalue.
    const double from_prior = prior / (value + prior);
    const double from_noise = std::min(1.0, e.dot(pose_noise * e) / (value + prior));
    s.open(i) =
        std::min(data::kJointPriorSd_m, data::kJointPriorSd_m * (from_prior + from_noise * from_noise) +
                                            from_noise * std::abs(e.dot(s.centre)));
  }
  return s;
}

/// Contribution of the rotation noise to the eigenvalues of the normal matrix: 2 (u'G_a u + v'G_b v), G = (tr
/// T I - T) / 2.
Matrix6 noise_of_poses(const Samples& samples, const SegmentPoses& a, const SegmentPoses& b,
                       const RelativeMotion& motion) {
  Matrix6 noise = Matrix6::Zero();
  const auto n = static_cast<std::int64_t>(motion.frames.size());
  const std::int64_t looked = std::min(n, kNoiseFrames);
  for (std::int64_t i = 0; i < looked; ++i) {
    const std::int64_t f = motion.frames[static_cast<std::size_t>(i * n / looked)];
    const Eigen::Matrix3d ta = pose_noise(samples, a, f).rotation_covariance,
                          tb = pose_noise(samples, b, f).rotation_covariance;
    noise.topLeftCorner<3, 3>() += ta.trace() * Eigen::Matrix3d::Identity() - ta;
    noise.bottomRightCorner<3, 3>() += tb.trace() * Eigen::Matrix3d::Identity() - tb;
  }
  return noise * (static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, looked)));
}

/// An axis has no sign: the one that lies with `like`.
Vector6 same_sign(const Vector6& axis, const Vector6& like) { return axis.dot(like) < 0.0 ? -axis : axis; }

}  // namespace

void ScoreSums::add(const SegmentPoses& a, const SegmentPoses& b, std::int64_t frame,
                    const Eigen::Matrix3d& weight) {
  const auto f = static_cast<std::size_t>(frame);
  Eigen::Matrix<double, 3, 6> design;
  design << a.world_from_segment[f], -b.world_from_segment[f];
  const Eigen::Vector3d y = b.origin[f] - a.origin[f], weighted = weight * y;
  normal += design.transpose() * weight * design;
  right += design.transpose() * weighted;
  squares += y.dot(weighted);
  frames += 1.0;
}

void ScoreSums::add(const SegmentPoses& a, const SegmentPoses& b, std::int64_t frame) {
  const auto f = static_cast<std::size_t>(frame);
  const Eigen::Matrix3d cross = a.world_from_segment[f].transpose() * b.world_from_segment[f];
  const Eigen::Vector3d y = b.origin[f] - a.origin[f];
  normal.topRightCorner<3, 3>() -= cross;
  normal.bottomLeftCorner<3, 3>() -= cross.transpose();
  normal.diagonal().array() += 1.0;
  right.head<3>() += a.world_from_segment[f].transpose() * y;
  right.tail<3>() -= b.world_from_segment[f].transpose() * y;
  squares += y.squaredNorm();
  frames += 1.0;
}

ScoreSums& ScoreSums::operator-=(const ScoreSums& other) {
  normal -= other.normal;
  right -= other.right;
  squares -= other.squares;
  frames -= other.frames;
  return *this;
}

ScoreSums& ScoreSums::operator+=(const ScoreSums& other) {
  normal += other.normal;
  right += other.right;
  squares += other.squares;
  frames += other.frames;
  return *this;
}

double ScoreSums::cost(const Vector6& p) const {
  return std::max(0.0, squares - 2.0 * p.dot(right) + p.dot(normal * p));
}

JointFit fit_score(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                   const RelativeMotion& motion, data::JointKind kind) {
  JointFit fit;
  fit.kind = kind;
  fit.method = kind == data::JointKind::hinge ? "SARA" : "SCoRE";
  fit.frames = static_cast<std::int64_t>(motion.frames.size());
  if (motion.frames.size() < kLeastFrames) return fit;
  fit.in_parent = fit.in_child = true;

  const auto n = static_cast<std::int64_t>(motion.frames.size());
  const std::int64_t blocks = std::min<std::int64_t>(kBlocks, n / 2);
  std::vector<ScoreSums> sums(static_cast<std::size_t>(blocks));
  ScoreSums all;
  for (std::int64_t i = 0; i < n; ++i)
    sums[static_cast<std::size_t>(i * blocks / n)].add(parent, child,
                                                       motion.frames[static_cast<std::size_t>(i)]);
  for (const ScoreSums& s : sums) all += s;

  const Matrix6 noise = noise_of_poses(samples, parent, child, motion);
  const double freedom = std::max(1.0, 3.0 * all.frames - 6.0);
  double variance = all.cost(solve(all, kind, 0.0, noise).centre) / freedom;
  const Solution best = solve(all, kind, variance, noise);
  variance = all.cost(best.centre) / freedom;
  fit.centre = best.centre;
  fit.residual_rms_m = std::sqrt(all.cost(best.centre) / all.frames);
  fit.axis_in_parent = best.axis.head<3>();
  fit.axis_in_child = best.axis.tail<3>();

  const double scale = static_cast<double>(blocks - 1) / static_cast<double>(blocks);
  for (const ScoreSums& s : sums) {
    ScoreSums rest = all;
    rest -= s;
    const Solution without = solve(rest, kind, variance, noise);
    Vector6 d = without.centre - best.centre;
    if (kind == data::JointKind::hinge) {
      const Vector6 axis = same_sign(without.axis, best.axis);
      const Eigen::Vector3d tilt = (axis - best.axis).head<3>();
      fit.axis_covariance += scale * tilt * tilt.transpose();
      // The position of the point along the axis is a convention and does not count as error.
      const Vector6 along = best.directions.col(0);
      d -= along * along.dot(d);
    }
    fit.scatter += scale * d * d.transpose();
  }
  fit.covariance = fit.repeatability = fit.scatter;
  if (kind == data::JointKind::hinge) {
    fit.axis_repeatability = fit.axis_covariance;
    fit.axis_sd_rad =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(fit.axis_covariance).eigenvalues()(2));
  }
  for (int i = 0; i < 6; ++i) {
    const double sd = best.open(i);
    fit.open += sd * sd * best.directions.col(i) * best.directions.col(i).transpose();
  }
  fit.covariance += fit.open;
  fit.repeatability += fit.open;
  return fit;
}

}  // namespace kinemark::skeleton
