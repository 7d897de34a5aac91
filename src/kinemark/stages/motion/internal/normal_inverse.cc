// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/normal_inverse.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {

void NormalInverse::invert(Eigen::MatrixXd& H, const Eigen::MatrixXd& C, double floor, Eigen::MatrixXd& K) {
  const Eigen::Index n = H.rows();
  H.diagonal().array() += floor;
  hold_speeds(H, problem_.fixed_speed);
  llt_.compute(H);
  while (llt_.info() != Eigen::Success) {  // rounding made the pivot of an undetermined direction negative
    floor = std::max(10.0 * floor, 1e-16);
    if (floor > 1e6) break;
    H.diagonal().array() += floor;
    llt_.compute(H);
  }
  K.setIdentity(n, n);
  llt_.solveInPlace(K);
  if (C.rows() > 0) {
    Eigen::MatrixXd free_C = C;
    for (Eigen::Index i = 0; i < n; ++i)
      if (problem_.fixed_speed[at(i)]) free_C.col(i).setZero();
    const Eigen::MatrixXd KC = K * free_C.transpose();
    Eigen::MatrixXd loop = free_C * KC;
    loop.diagonal().array() += 1e-12 * loop.trace() + 1e-300;
    K -= KC * loop.llt().solve(KC.transpose());
  }
  for (Eigen::Index i = 0; i < n; ++i)
    if (problem_.fixed_speed[at(i)]) {
      K.row(i).setZero();
      K.col(i).setZero();
    }
}

}  // namespace kinemark::motion::internal
