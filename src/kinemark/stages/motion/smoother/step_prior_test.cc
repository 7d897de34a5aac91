// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

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
