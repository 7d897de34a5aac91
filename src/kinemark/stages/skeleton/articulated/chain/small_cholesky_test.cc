// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(Random& random, Eigen::Index rows, Eigen::Index columns) {
  MatrixXd out(rows, columns);
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index r = 0; r < rows; ++r) out(r, c) = random.gaussian();
  return out;
}

TEST(SmallCholesky, FactorsAndSolvesOfAnySize) {
  Random random(1, 1);
  for (const Eigen::Index n : {1, 3, 9, 15}) {
    const MatrixXd root = random_matrix(random, n, n + 4);
    const MatrixXd A = root * root.transpose();
    MatrixXd L = A;
    ASSERT_TRUE(cholesky(L));
    const MatrixXd lower = L.triangularView<Eigen::Lower>();
    EXPECT_LT((lower * lower.transpose() - A).norm(), 1e-12 * A.norm()) << n;
    const VectorXd x = random_matrix(random, n, 1);
    VectorXd b = A * x;
    solve_cholesky(L, b);
    EXPECT_LT((b - x).norm(), 1e-8 * x.norm()) << n;
    VectorXd half = lower * x;
    solve_lower(L, half);
    EXPECT_LT((half - x).norm(), 1e-9 * x.norm()) << n;
    half = lower.transpose() * x;
    solve_upper(L, half);
    EXPECT_LT((half - x).norm(), 1e-9 * x.norm()) << n;
  }
}

TEST(SmallCholesky, FromLeavesFactorsAndSolvesOfAnySize) {
  Random random(2, 1);
  std::vector<Eigen::Index> rows;
  for (const Eigen::Index n : {1, 3, 9, 15}) {
    const MatrixXd root = random_matrix(random, n, n + 4);
    const MatrixXd A = root * root.transpose();
    MatrixXd U = A;
    ASSERT_TRUE(cholesky_from_leaves(U, rows));
    const MatrixXd upper = U.triangularView<Eigen::Upper>();
    EXPECT_LT((upper * upper.transpose() - A).norm(), 1e-12 * A.norm()) << n;
    const VectorXd x = random_matrix(random, n, 1);
    VectorXd half = upper * x;
    solve_from_leaves(U, half);
    EXPECT_LT((half - x).norm(), 1e-9 * x.norm()) << n;
    half = upper.transpose() * x;
    solve_to_leaves(U, half);
    EXPECT_LT((half - x).norm(), 1e-9 * x.norm()) << n;
  }
}

TEST(SmallCholesky, FromLeavesFillsNothingInATree) {
  // A root, two branches of two rows each: the branches know of each other through the root alone.
  MatrixXd A = MatrixXd::Identity(5, 5) * 4.0;
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {3, 4}})
    A(i, j) = A(j, i) = 1.0;
  std::vector<Eigen::Index> rows;
  ASSERT_TRUE(cholesky_from_leaves(A, rows));
  for (const auto& [i, j] : {std::pair{1, 3}, {1, 4}, {2, 3}, {2, 4}}) EXPECT_EQ(A(i, j), 0.0);
}

TEST(SmallCholesky, RefusesWhatIsNotPositive) {
  MatrixXd indefinite(2, 2), weak(2, 2);
  indefinite << 1.0, 2.0, 2.0, 1.0;
  weak << 1.0, 0.0, 0.0, 1e-6;
  MatrixXd same = indefinite;
  std::vector<Eigen::Index> rows;
  EXPECT_FALSE(cholesky_from_leaves(same, rows));
  EXPECT_FALSE(cholesky(indefinite));
  MatrixXd copy = weak;
  EXPECT_TRUE(cholesky(copy));
  copy = weak;
  EXPECT_FALSE(cholesky(copy, 1e-4)) << "a pivot below the least";
  MatrixXd nan = MatrixXd::Constant(1, 1, std::nan(""));
  EXPECT_FALSE(cholesky(nan));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
