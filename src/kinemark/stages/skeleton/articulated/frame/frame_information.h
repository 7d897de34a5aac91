// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which joints a frame determines, and how well.
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// What the normal matrix H of a frame determines: its pseudo-inverse, the rank decided at `tolerance`
/// relative to the largest eigenvalue (rotations measured in units of the chain's scale()).
class FrameInformation {
 public:
  /// H for unit noise. O(n_f^3).
  void set(const Chain& chain, const Eigen::MatrixXd& H, double tolerance = 1e-7);
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }  ///< n_f x n_f
  [[nodiscard]] int rank() const { return rank_; }
  /// True when the frame determines a joint: no change of parameters that the frame leaves open moves it.
  [[nodiscard]] bool holds(const Eigen::Matrix3Xd& by_frame) const;
  /// Information on a joint with everything else of the frame eliminated, for unit noise; of any rank.
  [[nodiscard]] Matrix3d joint_information(const Eigen::Matrix3Xd& by_frame) const;
  /// log det of H / sigma^2, where a rotation that the data do not determine counts as known to
  /// pi rad.
  [[nodiscard]] static double log_det(const Chain& chain, const Eigen::MatrixXd& H, double sigma_m,
                                      Eigen::MatrixXd& scratch);

 private:
  Eigen::MatrixXd inverse_, open_, factor_, scaled_;
  Eigen::VectorXd scale_;
  int rank_ = 0;
};

}  // namespace kinemark::skeleton::articulated
