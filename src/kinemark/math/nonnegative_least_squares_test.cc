// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/nonnegative_least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

TEST(NonnegativeLeastSquares, SatisfiesTheOptimalityConditions) {
  Random random(5, 0);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(30, 8, [&] { return random.gaussian(); });
    const Eigen::VectorXd y = Eigen::VectorXd::NullaryExpr(30, [&] { return random.gaussian(); });
    const Eigen::VectorXd x = nonnegative_least_squares(A.transpose() * A, A.transpose() * y);
    const Eigen::VectorXd gradient = A.transpose() * (A * x - y);
    for (int i = 0; i < 8; ++i) {
      EXPECT_GE(x[i], 0.0);
      EXPECT_GE(gradient[i], -1e-6);               // nothing to win by growing
      EXPECT_NEAR(x[i] * gradient[i], 0.0, 1e-6);  // complementary
    }
  }
}

TEST(NonnegativeLeastSquares, RecoversPositiveTruth) {
  Eigen::MatrixXd A(4, 2);
  A << 1, 0, 0, 1, 1, 1, 2, -1;
  const Eigen::Vector2d truth(3.0, 0.5);
  EXPECT_LT((nonnegative_least_squares(A.transpose() * A, A.transpose() * (A * truth)) - truth).norm(), 1e-8);
}

TEST(NonnegativeLeastSquares, LeavesUnseenUnknownsAtZero) {
  const Eigen::Matrix2d N = Eigen::Vector2d(2.0, 0.0).asDiagonal();
  EXPECT_EQ(nonnegative_least_squares(N, Eigen::Vector2d(4.0, 1.0)),
            Eigen::VectorXd(Eigen::Vector2d(2.0, 0.0)));
  EXPECT_THROW((void)nonnegative_least_squares(N, Eigen::Vector3d::Zero()), ContractError);
}

}  // namespace
}  // namespace kinemark::math
