// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/axis_slide.h"

#include <cmath>

#include "kinemark/stages/skeleton/functional/internal/alike.h"

namespace kinemark::skeleton::internal {
namespace {

using Eigen::Matrix3d;

/// Turn of a segment's markers per rad of the posture, in its own axes.
Matrix3d turn_of(const TurningSlide& side) {
  const double common = side.turn_m / side.cluster.radius_m;
  return side.own_m * side.own_m * side.cluster.inverse_inertia + common * common * Matrix3d::Identity();
}

/// Variance of each tilt by rotations about other axes that do not follow the hinge's angle.
double scatter_of(const RelativeMotion& motion, const Posture& posture, const JointFit& hinge) {
  const Eigen::Vector3d axis = motion.axes.transpose() * hinge.axis_in_child;
  const Eigen::VectorXd angle = posture.component * axis;
  const Eigen::MatrixX3d off = posture.component - angle * axis.transpose();
  const double frames = static_cast<double>(posture.component.rows()) / frames_alike(off, angle);
  const double swing = angle.squaredNorm() / static_cast<double>(angle.size());
  return off.squaredNorm() / (2.0 * static_cast<double>(angle.size())) / (frames * swing);
}

}  // namespace

Matrix3d axis_slide_covariance(const TurningSlide& parent, const TurningSlide& child,
                               const RelativeMotion& motion, const Posture& posture, const JointFit& hinge) {
  const Matrix3d all = turn_of(parent) + motion.mean * turn_of(child) * motion.mean.transpose() +
                       scatter_of(motion, posture, hinge) * Matrix3d::Identity();
  const Matrix3d across = Matrix3d::Identity() - hinge.axis_in_parent * hinge.axis_in_parent.transpose();
  return across * all * across;
}

}  // namespace kinemark::skeleton::internal
