// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/speed_covariance.h"

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kVaguest = 1e-2;  // 1 / (10 rad or m)^2
constexpr double kLocked = 1e12;
constexpr double kShutLoopSd_m = 1e-5;

}  // namespace

void SpeedCovariance::factor(model::Workspace& w, const Eigen::VectorXd& information, Eigen::Index held) {
  const auto& model = problem_.model;
  model::marker_normal_matrix(model, w, information, H_);
  if (!model.point_constraints().empty()) {
    model::point_constraint_jacobian(model, w, C_);
    H_.noalias() += C_.transpose() * C_ / (kShutLoopSd_m * kShutLoopSd_m);
  }
  for (Eigen::Index i = 0; i < H_.rows(); ++i) {
    if (!problem_.fixed_speed[at(i)] && i != held) {
      H_(i, i) += kVaguest;
      continue;
    }
    H_.row(i).setZero();
    H_.col(i).setZero();
    H_(i, i) = kLocked;
  }
  llt_.compute(H_);
}

void SpeedCovariance::invert(Eigen::MatrixXd& K) const {
  K.setIdentity(H_.rows(), H_.cols());
  llt_.solveInPlace(K);
}

}  // namespace kinemark::motion::internal
