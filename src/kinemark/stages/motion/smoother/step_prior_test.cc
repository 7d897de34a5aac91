// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

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

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Path {
  model::Model model = model::Model::compile(testing_body::description()).value();
  std::array<VectorXd, 4> x;
  MatrixXd precision;

  Path() {
    for (int a = 0; a < 4; ++a)  // 8 Hz: steps of several degrees
      x[static_cast<std::size_t>(a)] =
          model::state_from_coordinates(model, testing_body::coordinates(model, 5 + a, 8.0));
    // Steps of speeds beside each other belong together.
    const int n = model.speed_count();
    MatrixXd covariance = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) covariance(i, i) = 1e-4 * (1 + i);
    for (int i = 0; i + 1 < n; ++i) covariance(i, i + 1) = covariance(i + 1, i) = 4e-5 * (1 + i);
    precision = covariance.inverse();
  }
  [[nodiscard]] double cost() const {
    StepPrior prior(model, precision);
    return prior.visit(x[0], x[1], x[2], x[3]);
  }
  [[nodiscard]] double cost_after(int a, int i, double h) const {
    Path moved = *this;
    VectorXd dv = VectorXd::Zero(model.speed_count());
    dv[i] = h;
    model::integrate(model, moved.x[static_cast<std::size_t>(a)], dv);
    return moved.cost();
  }
};

TEST(StepPrior, GradientIsTheSlopeOfTheCost) {
  const Path path;
  StepPrior prior(path.model, path.precision);
  EXPECT_GT(prior.visit(path.x[0], path.x[1], path.x[2], path.x[3]), 0.1);
  for (int a = 0; a < 4; ++a) {
    VectorXd g = VectorXd::Zero(path.model.speed_count());
    prior.add_gradient(a, g);
    for (int i = 0; i < g.size(); ++i) {
      const double h = 1e-5;
      const double slope = (path.cost_after(a, i, h) - path.cost_after(a, i, -h)) / (2.0 * h);
      EXPECT_NEAR(g[i], slope, 1e-5 * (1.0 + g.norm())) << "posture " << a << ", speed " << i;
    }
  }
}

TEST(StepPrior, MatrixIsGaussNewton) {
  const Path path;
  const int n = path.model.speed_count();
  StepPrior prior(path.model, path.precision);
  Window window(n);
  // At a path of constant speed the cost is exactly quadratic to second order: compare with its curvature.
  Path still;
  VectorXd dv = VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) dv[i] = 0.02 * (i % 3) - 0.01;
  for (std::size_t a = 1; a < 4; ++a) {
    still.x[a] = still.x[a - 1];
    model::integrate(still.model, still.x[a], dv);
  }
  (void)prior.visit(still.x[0], still.x[1], still.x[2], still.x[3]);
  prior.add_to(window);
  const MatrixXd smooth = window.matrix().selfadjointView<Eigen::Lower>();
  Random random(1, 6);
  for (int trial = 0; trial < 5; ++trial) {
    VectorXd way(4 * n);
    for (double& w : way) w = random.gaussian();
    const double h = 1e-4;
    const auto cost_at = [&](double s) {
      Path moved = still;
      for (int a = 0; a < 4; ++a)
        model::integrate(moved.model, moved.x[static_cast<std::size_t>(a)], s * way.segment(a * n, n));
      return moved.cost();
    };
    const double curvature = (cost_at(h) - 2.0 * cost_at(0.0) + cost_at(-h)) / (h * h);
    EXPECT_NEAR(way.dot(smooth * way), curvature, 1e-4 * curvature);
  }
  EXPECT_GT(smooth.norm(), 0.0);
}

TEST(StepPrior, InverseJacobianTurnsWithTheLogarithm) {
  for (const double size : {1e-4, 0.3, 2.0}) {
    const Eigen::Vector3d d = size * Eigen::Vector3d(0.6, -0.48, 0.64);
    const Eigen::Matrix3d J = inverse_right_jacobian(d);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d small = 1e-6 * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d there = math::log_so3(math::exp_so3(d) * math::exp_so3(small));
      const Eigen::Vector3d back = math::log_so3(math::exp_so3(d) * math::exp_so3(-small));
      EXPECT_LT((J.col(i) - (there - back) / 2e-6).norm(), 1e-6);
    }
  }
}

TEST(StepPrior, StepsThatBelongTogetherCostLessTogether) {
  const Path path;
  Path plain = path;
  plain.precision = path.precision.inverse().diagonal().cwiseInverse().asDiagonal();
  const int shoulder = 6;  // the speed behind those of the root, and the next
  const auto cost = [](const Path& of, double first, double second) {
    Path moved = of;
    for (auto& x : moved.x) x = of.x[0];
    VectorXd way = VectorXd::Zero(of.model.speed_count());
    way[shoulder] = first, way[shoulder + 1] = second;
    model::integrate(moved.model, moved.x[3], way);
    return moved.cost();
  };
  EXPECT_LT(cost(path, 0.1, 0.1), 0.9 * cost(plain, 0.1, 0.1));
  EXPECT_GT(cost(path, 0.1, -0.1), 1.1 * cost(plain, 0.1, -0.1));
}

TEST(StepPrior, NeedsAPositivePrecision) {
  const Path path;
  EXPECT_THROW(StepPrior(path.model, MatrixXd::Zero(path.model.speed_count(), path.model.speed_count())),
               ContractError);
  EXPECT_THROW(StepPrior(path.model, MatrixXd::Identity(2, 2)), ContractError);
}

}  // namespace

}  // namespace kinemark::motion::internal
