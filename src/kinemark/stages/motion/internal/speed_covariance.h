// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the markers of a frame say of its pose, to first order.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

struct Problem;

/// Normal matrix of the speeds by markers of given information; nothing is vaguer than 10 rad or m.
class SpeedCovariance {
 public:
  explicit SpeedCovariance(const Problem& problem) : problem_(problem) {}

  /// The matrix at a pose.
  /// @param w            after kinematics() of the pose
  /// @param information  M, 1/m^2 of each marker per axis, 0 where it is not seen
  /// @param held         a speed that may not change; -1 for none
  void factor(model::Workspace& w, const Eigen::VectorXd& information, Eigen::Index held = -1);

  /// Its inverse, nv x nv; below 1e-12 for speeds that are locked or held.
  void invert(Eigen::MatrixXd& K) const;

  /// g (nv) becomes K g.
  void solve(Eigen::VectorXd& g) const { llt_.solveInPlace(g); }

 private:
  const Problem& problem_;
  Eigen::MatrixXd H_, C_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace kinemark::motion::internal
