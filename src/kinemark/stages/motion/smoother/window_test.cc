// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/window.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSize = 3, kNodes = 9;

/// A random banded system: n x n blocks, coupled over three neighbours.
struct Banded {
  MatrixXd A = MatrixXd::Zero(kSize * kNodes, kSize* kNodes);
  VectorXd b = VectorXd::Zero(kSize * kNodes);
  std::vector<MatrixXd> blocks;  // 4n x 4n of the term that begins at each node

  Banded() {
    Random random(3, 1);
    for (int k = 0; k < kNodes; ++k) {
      MatrixXd root(4 * kSize, 4 * kSize);
      for (double& x : root.reshaped()) x = random.gaussian();
      for (int a = 0; a < 4; ++a)
        if (k + a >= kNodes) root.middleCols(a * kSize, kSize).setZero();
      blocks.emplace_back(root.transpose() * root);
      for (int a = 0; a < 4 && k + a < kNodes; ++a)
        for (int c = 0; c < 4 && k + c < kNodes; ++c)
          A.block<kSize, kSize>((k + a) * kSize, (k + c) * kSize) +=
              blocks.back().block<kSize, kSize>(a * kSize, c * kSize);
    }
    for (double& x : b) x = random.gaussian();
  }

  std::vector<NodeFactor> eliminate(const std::vector<std::uint8_t>& held = {}) const {
    Window window(kSize);
    std::vector<NodeFactor> factors(kNodes);
    for (int k = 0; k < kNodes; ++k) {
      window.matrix().triangularView<Eigen::Lower>() += blocks[static_cast<std::size_t>(k)];
      window.right().head(kSize) += b.segment<kSize>(k * kSize);
      window.eliminate(held.empty() ? nullptr : held.data() + k * kSize,
                       factors[static_cast<std::size_t>(k)]);
    }
    return factors;
  }
};

VectorXd back_through(const std::vector<NodeFactor>& factors) {
  VectorXd x(kSize * kNodes), next = VectorXd::Zero(3 * kSize), own;
  for (int k = kNodes - 1; k >= 0; --k) {
    step_back(factors[static_cast<std::size_t>(k)], next, own);
    x.segment<kSize>(k * kSize) = own;
    next.tail(2 * kSize) = next.head(2 * kSize).eval();
    next.head(kSize) = own;
  }
  return x;
}

TEST(Window, SolvesTheBandedSystem) {
  const Banded system;
  const VectorXd x = back_through(system.eliminate());
  EXPECT_LT((system.A * x - system.b).norm(), 1e-9 * system.b.norm());
}

TEST(Window, HeldUnknownsRest) {
  const Banded system;
  std::vector<std::uint8_t> held(kSize * kNodes, 0);
  held[4] = held[5] = held[17] = held[26] = 1;
  const VectorXd x = back_through(system.eliminate(held));
  MatrixXd A = system.A;
  VectorXd b = system.b;
  for (int i = 0; i < A.rows(); ++i) {
    if (!held[static_cast<std::size_t>(i)]) continue;
    A.row(i).setZero();
    A.col(i).setZero();
    A(i, i) = 1.0;
    b[i] = 0.0;
    EXPECT_EQ(x[i], 0.0);
  }
  EXPECT_LT((A * x - b).norm(), 1e-9 * b.norm());
}

TEST(Window, CovariancesAreTheInverseWithinTheBand) {
  const Banded system;
  const auto factors = system.eliminate();
  const MatrixXd inverse = system.A.inverse();
  CovarianceWindow window(kSize);
  for (int k = kNodes - 1; k >= 0; --k) {
    window.step_back(factors[static_cast<std::size_t>(k)]);
    const int inside = std::min(3, kNodes - k) * kSize;
    EXPECT_LT(
        (window.matrix().topLeftCorner(inside, inside) - inverse.block(k * kSize, k * kSize, inside, inside))
            .norm(),
        1e-9 * inverse.norm())
        << "node " << k;
  }
}

TEST(Window, ASingularDirectionStaysFinite) {
  Window window(1);
  NodeFactor factor;
  window.eliminate(nullptr, factor);
  VectorXd step;
  step_back(factor, VectorXd::Zero(3), step);
  EXPECT_TRUE(step.allFinite());
}

}  // namespace
}  // namespace kinemark::motion::internal
