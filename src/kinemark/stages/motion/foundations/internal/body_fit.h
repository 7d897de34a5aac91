// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The most likely posture, sizes and marker places of a standing body, given where markers were seen.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion::internal {

/// What is known of the numbers that all frames share: sizes, joints, marker places. Normal, with mean and
/// information (inverse covariance).
struct SharedPrior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd information;
};

/// As the spreads of a body say.
[[nodiscard]] SharedPrior prior_of(const StandingBody& body);

/// One frame: where each marker of the body was seen, and how sure that is.
struct SeenFrame {
  Eigen::Matrix3Xd x;  ///< 3 x M, m; NaN: not seen
  Eigen::VectorXd sd;  ///< M, per axis, m
};

/// A fit of one frame.
struct BodyFit {
  Eigen::VectorXd pose, shared;  ///< numbers found
  double cost = 0.0;             ///< squared distances over variances, prior's included
  Eigen::Matrix3Xd residual;     ///< 3 x M, seen less expected, laboratory's axes, m; NaN: not seen
  Eigen::Matrix3d first =
      Eigen::Matrix3d::Identity();  ///< rotation that the first segment's turn counts from
  Eigen::Matrix3d world_from_root = Eigen::Matrix3d::Identity();  ///< axes of the first segment
  /// Jacobian of all seen coordinates, three rows a marker, by pose and shared numbers.
  Eigen::MatrixXd by_pose, by_shared;
  Eigen::MatrixXd information;  ///< posterior, pose first
  std::vector<int> rows;        ///< per marker: first row of it in the Jacobian; -1: not seen
};

/// Posture, sizes, joints and places of one frame. `near`: a fit of the same body to begin with; null: the
/// body stands, turned as fits best.
[[nodiscard]] BodyFit fit_body(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                               const BodyFit* near = nullptr);

/// What frames of one body tell of the shared numbers together: mean and information, postures left free.
[[nodiscard]] SharedPrior learn_shared(const StandingBody& body, const SharedPrior& prior,
                                       const std::vector<SeenFrame>& frames);

}  // namespace kinemark::motion::internal
