// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/nonnegative_least_squares.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::math {

Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& N, const Eigen::VectorXd& b,
                                          double tolerance) {
  check(N.rows() == N.cols() && N.rows() == b.size(), "N must be square and as large as b");
  const Eigen::Index n = b.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int sweep = 0; sweep < 10000; ++sweep) {
    double moved = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (N(i, i) <= 0.0) continue;
      const double next = std::max(0.0, x[i] + (b[i] - N.row(i).dot(x)) / N(i, i));
      moved = std::max(moved, std::abs(next - x[i]));
      x[i] = next;
    }
    if (moved <= tolerance * x.cwiseAbs().maxCoeff()) break;
  }
  return x;
}

}  // namespace kinemark::math
