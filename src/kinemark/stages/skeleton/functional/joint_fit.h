// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "kinemark/data/skeleton.h"

namespace kinemark::skeleton {

using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< parent's axes, then child's
using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< parent's axes, then child's

/// Blocks of consecutive frames of which one at a time is left out to see how far the answer moves: residuals
/// of a living body are alike from frame to frame, and only blocks show that.
constexpr int kBlocks = 30;

/// Position of a joint in its two segments.
struct JointFit {
  data::JointKind kind = data::JointKind::ball;  ///< ball or hinge
  bool in_parent = false, in_child = false;      ///< the place is known in that segment
  Vector6 centre = Vector6::Zero();              ///< in parent's axes, in child's axes, m
  Matrix6 covariance = Matrix6::Zero();          ///< m^2
  Matrix6 open = Matrix6::Zero();  ///< the part of it that motion and noise of the poses leave open
  /// unit length; zero for a ball joint
  Eigen::Vector3d axis_in_parent = Eigen::Vector3d::Zero(), axis_in_child = Eigen::Vector3d::Zero();
  double axis_sd_rad = 0.0;  ///< of each tilt
  double residual_rms_m =
      0.0;                  ///< length of the gap between the two places, or distance from the spheres, RMS
  std::int64_t frames = 0;  ///< used
  std::string method;       ///< name of the method that found it
};

}  // namespace kinemark::skeleton
