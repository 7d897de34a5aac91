// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/axis_slide.h"

#include <Eigen/LU>
#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/functional/internal/posture.h"
#include "kinemark/stages/skeleton/functional/internal/rigid_shape.h"

namespace kinemark::skeleton {
namespace {

using internal::Posture;

constexpr std::size_t kLeastAxisFrames = 40;
constexpr double kRigidShare = 4.0;  ///< energy of skin motion as one body over that of deformation

/// What deformation tells of a segment's turn, in its axes.
struct Turn {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< by one SD of the hinge's angle, rad^2
  double freedom = 0.0;                                  ///< numbers that tell it
};

/// A turn of the markers by one SD of the hinge's angle, rad^2, in the segment's axes.
Turn turn_of(const Samples& samples, const SegmentPoses& poses, const Posture& posture) {
  const auto K = static_cast<Eigen::Index>(poses.markers.size());
  double energy = 0.0;
  Eigen::Index placed = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < K; ++k) {
    const Eigen::Vector3d x = poses.x_in_segment.col(k);
    if (!x.allFinite()) continue;
    Eigen::Vector3d with = Eigen::Vector3d::Zero();
    double weight = 0.0, squares = 0.0, n = 0.0;
    for (std::size_t i = 0; i < posture.frames.size(); ++i) {
      const std::int64_t f = posture.frames[i];
      if (!samples.seen(f, poses.markers[at(k)])) continue;
      const double angle = posture.component(static_cast<Eigen::Index>(i), 0) / posture.sd_rad(0);
      const Eigen::Vector3d off = poses.to_segment(f, samples.x(f, poses.markers[at(k)])) - x;
      with += angle * off;
      weight += angle * angle;
      squares += off.squaredNorm();
      n += 1.0;
    }
    if (!(weight > 0.0)) continue;
    // Without what noise alone would show.
    energy += (with / weight).squaredNorm() - squares / (n * weight);
    mean += x;
    ++placed;
  }
  if (placed < 3) return {};
  energy = std::max(energy, 0.0);
  mean /= static_cast<double>(placed);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (Eigen::Index k = 0; k < K; ++k) {
    const Eigen::Vector3d d = poses.x_in_segment.col(k) - mean;
    if (d.allFinite()) scatter += d * d.transpose();
  }
  // Six ways to move as one body have kRigidShare times the energy of all others together.
  return {.covariance = kRigidShare * energy / 6.0 * internal::inertia(scatter).inverse(),
          .freedom = 3.0 * static_cast<double>(placed) - 6.0};
}

}  // namespace

Eigen::Matrix3d axis_slide_covariance(const Samples& samples, const SegmentPoses& parent,
                                      const SegmentPoses& child, const RelativeMotion& motion,
                                      const Eigen::Vector3d& axis_in_parent, const SkinPrior& prior) {
  if (motion.frames.size() < kLeastAxisFrames) return Eigen::Matrix3d::Zero();
  const Posture posture = internal::posture_of(parent, child, motion);
  if (!(posture.sd_rad(0) > 0.0)) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d to_parent = motion.mean;
  const Turn above = turn_of(samples, parent, posture), below = turn_of(samples, child, posture);
  const Eigen::Matrix3d shown = (above.covariance + to_parent * below.covariance * to_parent.transpose()) /
                                (posture.sd_rad(0) * posture.sd_rad(0));
  // A variance that two sources tell: their mean, by the numbers that each rests on.
  const double numbers = above.freedom + below.freedom;
  const Eigen::Matrix3d both =
      (numbers * shown + prior.turn_weight * prior.turn * prior.turn * Eigen::Matrix3d::Identity()) /
      (numbers + prior.turn_weight);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis_in_parent * axis_in_parent.transpose();
  return across * both * across;
}

}  // namespace kinemark::skeleton
