// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/lbfgs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::skeleton::internal {
namespace {

TEST(Lbfgs, FindsTheBottomOfRosenbrocksValley) {
  Eigen::VectorXd x(10);
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = i % 2 ? 1.0 : -1.2;
  int calls = 0;
  const auto valley = [&](const Eigen::VectorXd& at, Eigen::VectorXd& g) {
    ++calls;
    double value = 0.0;
    for (Eigen::Index i = 0; i < at.size(); i += 2) {
      const double a = at(i + 1) - at(i) * at(i), b = 1.0 - at(i);
      value += 100.0 * a * a + b * b;
      g(i) = -400.0 * a * at(i) - 2.0 * b;
      g(i + 1) = 200.0 * a;
    }
    return value;
  };
  EXPECT_LT(minimise_lbfgs(valley, x, {.cost_tolerance = 0.0}), 1e-16);
  for (const double c : x) EXPECT_NEAR(c, 1.0, 1e-8);
  EXPECT_LT(calls, 200);
}

TEST(Lbfgs, AQuadraticOfAnyScaleTakesFewSteps) {
  const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(20, 1.0, 1000.0);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(20);
  int calls = 0;
  const auto bowl = [&](const Eigen::VectorXd& at, Eigen::VectorXd& g) {
    ++calls;
    g = scale.cwiseProduct(at);
    return 0.5 * at.dot(g);
  };
  EXPECT_LT(minimise_lbfgs(bowl, x, {.cost_tolerance = 0.0, .gradient_tolerance = 1e-8}), 1e-15);
  EXPECT_LT(calls, 300);
}

TEST(Lbfgs, StopsWhereItStartsWhenThatIsTheBottom) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  const auto bowl = [](const Eigen::VectorXd& at, Eigen::VectorXd& g) {
    g = 2.0 * at;
    return at.squaredNorm();
  };
  EXPECT_EQ(minimise_lbfgs(bowl, x), 0.0);
  EXPECT_EQ(x.norm(), 0.0);
}

TEST(Lbfgs, AKinkDoesNotTrapIt) {
  Eigen::VectorXd x(2);
  x << 3.0, -2.0;
  const auto kink = [](const Eigen::VectorXd& at, Eigen::VectorXd& g) {
    g << (at(0) > 0 ? 1.0 : -1.0), 2.0 * at(1);
    return std::abs(at(0)) + at(1) * at(1);
  };
  EXPECT_LT(minimise_lbfgs(kink, x, {.iterations = 200}), 0.5);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
