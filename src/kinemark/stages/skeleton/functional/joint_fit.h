// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/data/skeleton.h"

namespace kinemark::skeleton {

using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< parent's axes, then child's
using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< parent's axes, then child's

/// Number of blocks of consecutive frames for the jackknife: one block at a time is left out. Residuals of a
/// living body are correlated from frame to frame, so single frames would understate the variance.
constexpr int kBlocks = 30;

/// Position of a joint in its two segments.
struct JointFit {
  data::JointKind kind = data::JointKind::ball;  ///< ball or hinge
  bool in_parent = false, in_child = false;      ///< the position is known in that segment
  Vector6 centre = Vector6::Zero();              ///< in parent's axes, in child's axes, m
  Matrix6 covariance = Matrix6::Zero();          ///< m^2
  /// By how much another part of the trial would differ, m^2: `covariance` less what all parts share.
  Matrix6 repeatability = Matrix6::Zero();
  Matrix6 scatter =
      Matrix6::Zero();             ///< the part of it that blocks of frames show: what does not repeat itself
  Matrix6 open = Matrix6::Zero();  ///< the part of it due to lack of motion and noise of the poses
  /// unit length; zero for a ball joint
  Eigen::Vector3d axis_in_parent = Eigen::Vector3d::Zero(), axis_in_child = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axis_covariance = Eigen::Matrix3d::Zero();  ///< of the unit vector in the parent, rad^2
  /// The same of what another part of the trial would differ by; NaN when unknown.
  Eigen::Matrix3d axis_repeatability = Eigen::Matrix3d::Constant(kNaN);
  double axis_sd_rad = 0.0;     ///< of the tilt that is known less
  double prior_share = kNaN;    ///< SkinSlide::prior_share; NaN: skin was not looked at
  data::SkinAccount skin;       ///< what the recording shows of skin that slides with the posture
  double residual_rms_m = 0.0;  ///< distance between the two positions, or distance from the spheres, RMS
  std::int64_t frames = 0;      ///< used
  std::string method;           ///< name of the method that found it
};

}  // namespace kinemark::skeleton
