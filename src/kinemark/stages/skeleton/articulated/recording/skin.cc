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
#include "kinemark/stages/skeleton/functional/skin_evidence.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;

Matrix3d widened(const Matrix3d& C, const Vector3d& axis, double size_m) {
  const double more = size_m * size_m - axis.dot(C * axis);
  return more > 0.0 ? Matrix3d(C + more * axis * axis.transpose()) : C;
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// What skin does to a joint that the chain found.
struct Correction {
  Vector6 shift = Vector6::Zero();        ///< of the joint in both segments, m
  Matrix6 slides = Matrix6::Zero();       ///< covariance by slides, m^2
  Matrix3d in_parent = Matrix3d::Zero();  ///< covariance that comes to that of independent frames, m^2
  Matrix3d in_child = Matrix3d::Zero();
};

/// The nearest frames with a pose of a segment, for those without; -1 where there is none.
std::vector<std::int64_t> nearest_known(const SegmentPoses& poses) {
  const auto F = static_cast<std::int64_t>(poses.known.size());
  std::vector<std::int64_t> out(poses.known.size(), -1);
  std::int64_t before = -1;
  for (std::int64_t f = 0; f < F; ++f) {
    if (poses.known[at(f)] != 0) before = f;
    out[at(f)] = before;
  }
  std::int64_t after = -1;
  for (std::int64_t f = F - 1; f >= 0; --f) {
    if (poses.known[at(f)] != 0) after = f;
    if (after >= 0 && (out[at(f)] < 0 || after - f < f - out[at(f)])) out[at(f)] = after;
  }
  return out;
}

/// Moves and widens the joint in every frame that places it. A segment without a pose in a frame has that of
/// the nearest frame: only its direction matters.
void correct_centres(std::size_t j, const SegmentPoses& parent, const SegmentPoses& child,
                     const Correction& by, data::Skeleton& skeleton) {
  const auto above = nearest_known(parent), below = nearest_known(child);
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const std::size_t i = skeleton.index(f, static_cast<std::int64_t>(j));
    if (skeleton.state[i] == data::CentreState::undetermined) continue;
    const Matrix3d& R = parent.world_from_segment[at(above[at(f)])];
    const Matrix3d& S = child.world_from_segment[at(below[at(f)])];
    const bool in_parent = parent.known[at(f)] != 0, in_child = child.known[at(f)] != 0;
    const double share = in_parent == in_child ? 0.5 : in_parent ? 1.0 : 0.0;
    Eigen::Matrix<double, 3, 6> rotation;
    rotation.leftCols<3>() = share * R;
    rotation.rightCols<3>() = (1.0 - share) * S;
    Eigen::Map<Vector3d>(skeleton.centre_in_world.data() + 3 * i) += rotation * by.shift;
    const Matrix3d wider = skeleton.centre_covariance(f, static_cast<std::int64_t>(j)) +
                           rotation * by.slides * rotation.transpose() +
                           share * R * by.in_parent * R.transpose() +
                           (1.0 - share) * S * by.in_child * S.transpose();
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

/// What a covariance of independent frames lacks where only one of `alike` frames counts; for a hinge across
/// its axis, along which nothing is known anyway.
Matrix3d of_fewer_frames(const Matrix3d& C, double alike, const Vector3d& axis) {
  const Matrix3d across = Matrix3d::Identity() - axis * axis.transpose();
  return (alike - 1.0) * across * C * across;
}

void widen_axis(const SkinSlide& slide, data::SkeletonJoint& joint) {
  joint.axis_covariance_in_parent = slide.axis_covariance;
  joint.axis_repeatability_in_parent *= slide.frames_alike;
  joint.axis_sd_rad =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(joint.axis_covariance_in_parent).eigenvalues()(2));
}

void account_for_joint(const Samples& samples, std::size_t j, const SegmentPoses& parent,
                       const SegmentPoses& child, data::Skeleton& skeleton) {
  auto& joint = skeleton.joints[j];
  if (parent.known_frames == 0 || child.known_frames == 0 || !joint.covariance_in_parent.allFinite() ||
      !joint.covariance_in_child.allFinite())
    return;
  const RelativeMotion motion = measure_motion(parent, child);
  const JointFit fit = fit_score(samples, parent, child, motion, joint.kind);
  if (!fit.in_parent) return;
  const SkinSlide slide = measure_skin_slide(samples, parent, child, motion, fit);
  if (!slide.known) return;
  const SkinEvidence evidence = find_skin(samples, parent, child, motion, fit);
  joint.skin = account_of_skin(evidence, slide);
  // Half-way to the expected place where skin is seen: the prior's size is no more sure. Else the joint
  // stays, and the whole way counts as error.
  Correction by;
  if (joint.skin.verdict == data::SkinVerdict::follows) by.shift = 0.5 * slide.shift;
  const Vector6 rest = slide.shift - by.shift;
  // Where no marker slides the way is least squares' own error by noise, which the chain does not share.
  // Frames alone take slow noise for slides; movements that do not predict each other speak against these.
  const double likely = calc_skin_probability(evidence);
  by.slides =
      likely * (positive_part(slide.covariance - slide.noise) + (1.0 - slide.none) * rest * rest.transpose());
  by.in_parent = of_fewer_frames(joint.covariance_in_parent, slide.frames_alike, joint.axis_in_parent);
  by.in_child = of_fewer_frames(joint.covariance_in_child, slide.frames_alike, joint.axis_in_child);
  // Another part of the trial may move the joint otherwise, or, where it shows no skin, not at all.
  const Matrix6 repeats =
      likely * positive_part(slide.repeatability - slide.noise) + by.shift * by.shift.transpose();
  joint.repeatability_in_parent += by.in_parent + repeats.topLeftCorner<3, 3>();
  joint.repeatability_in_child += by.in_child + repeats.bottomRightCorner<3, 3>();
  joint.centre_in_parent += by.shift.head<3>();
  joint.centre_in_child += by.shift.tail<3>();
  joint.covariance_in_parent += by.in_parent + by.slides.topLeftCorner<3, 3>();
  joint.covariance_in_child += by.in_child + by.slides.bottomRightCorner<3, 3>();
  if (joint.kind == data::JointKind::hinge) widen_axis(slide, joint);
  joint.prior_share = slide.prior_share;
  joint.range_of_motion_rad = motion.range_rad;
  joint.description = describe_joint(joint, motion.sd_rad);
  correct_centres(j, parent, child, by, skeleton);
  widen_lengths(static_cast<int>(j), skeleton);
}

}  // namespace

void widen_along_axis(const std::vector<SampledPose>& sampled, int chain_segment, const Vector3d& axis,
                      int joint, double size_m, data::Skeleton& skeleton) {
  std::size_t next = 0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    while (next + 1 < sampled.size() && sampled[next + 1].frame <= f) ++next;
    const std::size_t i = skeleton.index(f, joint);
    if (next >= sampled.size() || skeleton.state[i] == CentreState::undetermined) continue;
    const Vector3d in_world = sampled[next].pose.rotation[static_cast<std::size_t>(chain_segment)] * axis;
    store_symmetric(skeleton.covariance.data() + 6 * i,
                    widened(skeleton.centre_covariance(f, joint), in_world, size_m));
  }
  auto& changed = skeleton.joints[static_cast<std::size_t>(joint)];
  changed.covariance_in_parent = widened(changed.covariance_in_parent, changed.axis_in_parent, size_m);
  changed.covariance_in_child = widened(changed.covariance_in_child, changed.axis_in_child, size_m);
  changed.repeatability_in_parent = widened(changed.repeatability_in_parent, changed.axis_in_parent, size_m);
  changed.repeatability_in_child = widened(changed.repeatability_in_child, changed.axis_in_child, size_m);
}

void widen_all_around(int joint, double size_m, data::Skeleton& skeleton) {
  const Matrix3d more = size_m * size_m * Matrix3d::Identity();
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const std::size_t i = skeleton.index(f, joint);
    if (skeleton.state[i] != CentreState::undetermined)
      store_symmetric(skeleton.covariance.data() + 6 * i, skeleton.centre_covariance(f, joint) + more);
  }
  auto& changed = skeleton.joints[static_cast<std::size_t>(joint)];
  changed.covariance_in_parent += more;
  changed.covariance_in_child += more;
  changed.repeatability_in_parent += more;
  changed.repeatability_in_child += more;
}

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
