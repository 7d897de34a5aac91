// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/functional/description.h"
#include "kinemark/stages/skeleton/functional/internal/assemble.h"

namespace kinemark::skeleton::internal {
namespace {

void set_centre(data::Skeleton& skeleton, std::size_t i, const Eigen::Vector3d& centre,
                const Eigen::Matrix3d& covariance, data::CentreState state) {
  skeleton.state[i] = state;
  Eigen::Map<Eigen::Vector3d>(skeleton.centre_in_world.data() + 3 * i) = centre;
  math::pack_symmetric3(covariance, skeleton.covariance.data() + 6 * i);
}

/// The estimate of one side in a frame.
struct Side {
  bool known = false;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero(), rotation = Eigen::Matrix3d::Zero();
};

Side side_at(const Samples& samples, const SegmentPoses& poses, std::int64_t f, bool used,
             const Eigen::Vector3d& p) {
  Side side;
  side.known = used && poses.known[static_cast<std::size_t>(f)] != 0;
  if (!side.known) return side;
  side.rotation = poses.world_from_segment[static_cast<std::size_t>(f)];
  side.centre = poses.to_world(f, p);
  side.noise = pose_noise(samples, poses, f).at(side.rotation, p);
  return side;
}

/// Variance of the gap between the two positions over that predicted from the noise of the poses, >= 1.
double gap_ratio(const Samples& samples, const JointTask& task, const JointFit& fit) {
  if (!fit.in_parent || !fit.in_child || fit.kind == data::JointKind::hinge) return 1.0;
  double gaps = 0.0, expected = 0.0;
  for (const std::int64_t f : task.motion.frames) {
    const Side a = side_at(samples, task.parent, f, true, fit.centre.head<3>()),
               b = side_at(samples, task.child, f, true, fit.centre.tail<3>());
    gaps += (a.centre - b.centre).squaredNorm();
    expected += (a.noise + b.noise).trace();
  }
  return expected > 0.0 ? std::max(1.0, gaps / expected) : 1.0;
}

}  // namespace

void place_joint(const Samples& samples, const JointTask& task, const JointFit& fit, std::size_t j,
                 data::Skeleton& skeleton) {
  const double ratio = gap_ratio(samples, task, fit);
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const Side a = side_at(samples, task.parent, f, fit.in_parent, fit.centre.head<3>()),
               b = side_at(samples, task.child, f, fit.in_child, fit.centre.tail<3>());
    if (!a.known && !b.known) continue;
    const double share_a = !b.known ? 1.0 : !a.known ? 0.0 : 0.5, share_b = 1.0 - share_a;
    Eigen::Matrix<double, 3, 6> rotation;
    rotation.leftCols<3>() = share_a * a.rotation;
    rotation.rightCols<3>() = share_b * b.rotation;
    const Eigen::Matrix3d covariance = ratio * (share_a * share_a * a.noise + share_b * share_b * b.noise) +
                                       rotation * fit.covariance * rotation.transpose();
    set_centre(skeleton, skeleton.index(f, static_cast<std::int64_t>(j)),
               share_a * a.centre + share_b * b.centre, covariance, data::CentreState::determined);
  }
}

void place_joint(const ConstantDistanceFit& fit, std::size_t j, data::Skeleton& skeleton) {
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    if (fit.state[i] == data::CentreState::undetermined) continue;
    set_centre(skeleton, skeleton.index(f, static_cast<std::int64_t>(j)), fit.centre_in_world[i],
               fit.covariance[i], fit.state[i]);
  }
}

void describe(const JointFit& fit, const RelativeMotion& motion, data::SkeletonJoint& out) {
  out.kind = fit.kind;
  out.method = fit.method;
  const Eigen::Matrix3d unknown = Eigen::Matrix3d::Constant(kNaN);
  if (fit.in_parent) out.centre_in_parent = fit.centre.head<3>();
  if (fit.in_child) out.centre_in_child = fit.centre.tail<3>();
  out.covariance_in_parent = fit.in_parent ? Eigen::Matrix3d(fit.covariance.topLeftCorner<3, 3>()) : unknown;
  out.covariance_in_child =
      fit.in_child ? Eigen::Matrix3d(fit.covariance.bottomRightCorner<3, 3>()) : unknown;
  if (fit.in_parent) out.repeatability_in_parent = fit.repeatability.topLeftCorner<3, 3>();
  if (fit.in_child) out.repeatability_in_child = fit.repeatability.bottomRightCorner<3, 3>();
  if (fit.kind == data::JointKind::hinge) {
    out.axis_repeatability_in_parent = fit.axis_repeatability;
    out.axis_in_parent = fit.axis_in_parent;
    out.axis_in_child = fit.axis_in_child;
    out.axis_sd_rad = fit.axis_sd_rad;
    out.axis_covariance_in_parent = fit.axis_covariance;
  }
  out.prior_share = fit.prior_share;
  out.skin = fit.skin;
  out.range_of_motion_rad = motion.frames.size() > 1 ? motion.range_rad : kNaN;
  out.description = describe_joint(out, motion.sd_rad);
}

void add_lengths(data::Skeleton& skeleton) {
  const auto J = skeleton.joints.size();
  for (std::size_t s = 0; s < skeleton.segments.size(); ++s)
    for (std::size_t a = 0; a < J; ++a)
      for (std::size_t b = a + 1; b < J; ++b) {
        const auto centre_of = [&](const data::SkeletonJoint& joint, Eigen::Matrix3d& covariance) {
          const bool parent = joint.parent_segment == static_cast<int>(s);
          covariance = parent ? joint.covariance_in_parent : joint.covariance_in_child;
          return parent ? joint.centre_in_parent : joint.centre_in_child;
        };
        const auto on = [&](const data::SkeletonJoint& joint) {
          return joint.parent_segment == static_cast<int>(s) || joint.child_segment == static_cast<int>(s);
        };
        if (!on(skeleton.joints[a]) || !on(skeleton.joints[b])) continue;
        Eigen::Matrix3d ca, cb;
        const Eigen::Vector3d d = centre_of(skeleton.joints[a], ca) - centre_of(skeleton.joints[b], cb);
        if (!ca.allFinite() || !cb.allFinite() || d.norm() == 0.0) continue;
        const Eigen::Vector3d along = d.normalized();
        skeleton.lengths.push_back({.name = skeleton.joints[a].name + "-" + skeleton.joints[b].name,
                                    .joint_a = static_cast<int>(a),
                                    .joint_b = static_cast<int>(b),
                                    .length_m = d.norm(),
                                    .sd_m = std::sqrt(along.dot((ca + cb) * along))});
      }
}

}  // namespace kinemark::skeleton::internal
