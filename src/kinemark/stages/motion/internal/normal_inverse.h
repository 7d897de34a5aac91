// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Inverse of a normal matrix on the speeds that may move and within the closed loops.
class NormalInverse {
 public:
  explicit NormalInverse(const Problem& problem) : problem_(problem) {}

  /// K = (H + floor)^-1, 0 for speeds that are locked. H is changed.
  /// @param C  point_constraint_jacobian(); no rows without loops
  void invert(Eigen::MatrixXd& H, const Eigen::MatrixXd& C, double floor, Eigen::MatrixXd& K);

 private:
  const Problem& problem_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace kinemark::motion::internal
