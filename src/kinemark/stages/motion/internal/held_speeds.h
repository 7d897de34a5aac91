// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {

/// Take the speeds that are held out of a symmetric matrix of all speeds: their rows and columns become those
/// of the identity, so that it stays positive definite and moves them by their own right-hand side alone.
inline void hold_speeds(Eigen::MatrixXd& M, const std::vector<std::uint8_t>& held) {
  for (Eigen::Index k = 0; k < M.rows(); ++k) {
    if (held[at(k)] == 0) continue;
    M.row(k).setZero();
    M.col(k).setZero();
    M(k, k) = 1.0;
  }
}

}  // namespace kinemark::motion::internal
