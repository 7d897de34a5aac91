// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/skin.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/functional/description.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSlides = 0.5;  ///< probability beyond which skin is taken to slide

/// The covariance of a joint in both segments, on top of that of its centres in every frame that shows a
/// pose.
void widen_centres(std::size_t j, const SegmentPoses& parent, const SegmentPoses& child,
                   const Matrix6& covariance, data::Skeleton& skeleton) {
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const std::size_t i = skeleton.index(f, static_cast<std::int64_t>(j));
    const bool in_parent = parent.known[at(f)] != 0, in_child = child.known[at(f)] != 0;
    if (skeleton.state[i] == data::CentreState::undetermined || (!in_parent && !in_child)) continue;
    const double share = !in_child ? 1.0 : !in_parent ? 0.0 : 0.5;
    Eigen::Matrix<double, 3, 6> rotation;
    rotation.leftCols<3>() = share * parent.world_from_segment[at(f)];
    rotation.rightCols<3>() = (1.0 - share) * child.world_from_segment[at(f)];
    const Matrix3d wider = skeleton.centre_covariance(f, static_cast<std::int64_t>(j)) +
                           rotation * covariance * rotation.transpose();
    math::pack_symmetric3(wider, skeleton.covariance.data() + 6 * i);
  }
}

/// Standard deviations of lengths from or to a joint, from its covariance as it is now.
void widen_lengths(int joint, data::Skeleton& skeleton) {
  for (auto& length : skeleton.lengths) {
    if (length.joint_a != joint && length.joint_b != joint) continue;
    const auto &a = skeleton.joints[at(length.joint_a)], &b = skeleton.joints[at(length.joint_b)];
    const bool a_in_parent = a.parent_segment == b.parent_segment || a.parent_segment == b.child_segment;
    const int segment = a_in_parent ? a.parent_segment : a.child_segment;
    const bool b_in_parent = b.parent_segment == segment;
    const Vector3d d = (b_in_parent ? b.centre_in_parent : b.centre_in_child) -
                       (a_in_parent ? a.centre_in_parent : a.centre_in_child);
    const Vector3d along = d.normalized();
    const Matrix3d C = (a_in_parent ? a.covariance_in_parent : a.covariance_in_child) +
                       (b_in_parent ? b.covariance_in_parent : b.covariance_in_child);
    length.sd_m = std::sqrt(along.dot(C * along));
  }
}

void account_for_joint(const Samples& samples, std::size_t j, const SegmentPoses& parent,
                       const SegmentPoses& child, data::Skeleton& skeleton) {
  auto& joint = skeleton.joints[j];
  if (parent.known_frames == 0 || child.known_frames == 0 || !joint.covariance_in_parent.allFinite() ||
      !joint.covariance_in_child.allFinite())
    return;
  const RelativeMotion motion = measure_motion(parent, child);
  const JointFit fit = fit_score(samples, parent, child, motion, joint.kind);
  if (!fit.in_parent || !(fit.slide_share > kSlides)) return;
  Vector6 shift = fit.centre;
  shift.head<3>() -= joint.centre_in_parent;
  shift.tail<3>() -= joint.centre_in_child;
  const Matrix6 covariance = fit.covariance + shift * shift.transpose();
  joint.covariance_in_parent += covariance.topLeftCorner<3, 3>();
  joint.covariance_in_child += covariance.bottomRightCorner<3, 3>();
  const Matrix6 repeatability = fit.repeatability + shift * shift.transpose();
  joint.repeatability_in_parent += repeatability.topLeftCorner<3, 3>();
  joint.repeatability_in_child += repeatability.bottomRightCorner<3, 3>();
  if (joint.kind == data::JointKind::hinge) {
    joint.axis_covariance_in_parent += fit.axis_covariance;
    joint.axis_repeatability_in_parent += fit.axis_repeatability;
    joint.axis_sd_rad =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(joint.axis_covariance_in_parent).eigenvalues()(2));
  }
  joint.range_of_motion_rad = motion.range_rad;
  joint.description = describe_joint(joint, motion.sd_rad) + ", as skin slides with the posture";
  widen_centres(j, parent, child, covariance, skeleton);
  widen_lengths(static_cast<int>(j), skeleton);
}

}  // namespace

void account_for_skin(const data::Trajectories& markers, data::Skeleton& skeleton) {
  const Samples samples{markers, {}};
  std::vector<SegmentPoses> poses;
  for (const auto& segment : skeleton.segments)
    poses.push_back(segment.markers.size() < 3 || segment.kind == data::SegmentKind::line
                        ? SegmentPoses{}
                        : pose_known_shape(samples, segment.name, segment.markers, segment.x_in_segment));
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
    account_for_joint(samples, j, poses[at(skeleton.joints[j].parent_segment)],
                      poses[at(skeleton.joints[j].child_segment)], skeleton);
}

}  // namespace kinemark::skeleton::articulated
