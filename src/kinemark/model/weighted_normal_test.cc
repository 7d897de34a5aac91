// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/weighted_normal.h"

#include <gtest/gtest.h>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using testing::random_state;
using testing::random_tree;
using testing::random_vector;
using testing::relative_error;

class WeightedNormal : public ::testing::TestWithParam<int> {
 protected:
  std::uint64_t seed() const { return static_cast<std::uint64_t>(GetParam() / 2); }
  Random random{seed() + 300, 2};
  Model model = Model::compile(random_tree(seed()), {.free_roots = GetParam() % 2 == 0}).value();
  Workspace w{model};
  VectorXd weight;
  Eigen::Matrix3Xd target;

  void SetUp() override {
    weight = random_vector(model.marker_count(), 1.0, random).cwiseAbs();
    weight[2] = weight[7] = 0.0;  // missing markers
    target = random_vector(3 * model.marker_count(), 1.0, random).reshaped(3, model.marker_count());
    target.col(2).setConstant(NAN);  // and what is missing must never be read
  }
  Eigen::Matrix3Xd residual() const { return target - w.marker; }
  VectorXd weights_per_row() const { return weight.transpose().replicate(3, 1).reshaped(); }
  // J'Wr at a state: minus the gradient of sum w |r|^2 / 2.
  VectorXd descent_at(const VectorXd& x) {
    kinematics(model, w, x);
    clear_forces(w);
    add_marker_forces(model, w, weight, residual());
    VectorXd g;
    project_forces(model, w, g);
    return g;
  }
};

INSTANTIATE_TEST_SUITE_P(Seeds, WeightedNormal, ::testing::Range(0, 16));

TEST_P(WeightedNormal, NormalMatrixIsJTransposedWJ) {
  kinematics(model, w, random_state(model, random));
  Eigen::MatrixXd J, H;
  marker_jacobian(model, w, J);
  marker_normal_matrix(model, w, weight, H);
  EXPECT_LT(relative_error(H, J.transpose() * weights_per_row().asDiagonal() * J), 1e-13);
  EXPECT_EQ(H, H.transpose());
}

TEST_P(WeightedNormal, ProjectedForcesAreJTransposedWr) {
  const VectorXd g = descent_at(random_state(model, random));
  Eigen::MatrixXd J;
  marker_jacobian(model, w, J);
  Eigen::Matrix3Xd r = residual();
  r.col(2).setZero();
  EXPECT_LT(relative_error(g, J.transpose() * weights_per_row().cwiseProduct(r.reshaped())), 1e-13);
}

TEST_P(WeightedNormal, WithTheCurvatureItIsTheHessianOfTheCost) {
  const VectorXd x = random_state(model, random);
  const int n = model.speed_count();
  // Second derivative along the moves of integrate(): the symmetric part of the gradient's slope, because the
  // gradient is taken along the turned axes of a free joint.
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd slope(n, n);
  for (int i = 0; i < n; ++i) {
    VectorXd ahead = x, behind = x;
    integrate(model, ahead, kStep * VectorXd::Unit(n, i));
    integrate(model, behind, -kStep * VectorXd::Unit(n, i));
    slope.col(i) = -(descent_at(ahead) - descent_at(behind)) / (2.0 * kStep);
  }
  kinematics(model, w, x);
  Eigen::MatrixXd H;
  marker_normal_matrix(model, w, weight, H);
  descent_at(x);
  const Eigen::MatrixXd gauss_newton = H;
  subtract_force_curvature(model, w, H);
  EXPECT_LT(relative_error(H, 0.5 * (slope + slope.transpose())), 1e-6);
  EXPECT_GT(relative_error(gauss_newton, 0.5 * (slope + slope.transpose())), 1e-2)
      << "the curvature must matter here";
}

TEST_P(WeightedNormal, CurvatureMatchesSecondDifferencesOfTheCost) {
  // Unrelated to the gradient code: one random direction, cost only.
  const VectorXd x = random_state(model, random), d = random_vector(model.speed_count(), 0.5, random);
  const auto cost_at = [&](double step) {
    VectorXd y = x;
    integrate(model, y, step * d);
    kinematics(model, w, y);
    double sum = 0.0;
    for (int m = 0; m < model.marker_count(); ++m)
      if (weight[m] > 0.0) sum += 0.5 * weight[m] * residual().col(m).squaredNorm();
    return sum;
  };
  constexpr double kStep = 2e-4;
  const double expected = (cost_at(kStep) - 2.0 * cost_at(0.0) + cost_at(-kStep)) / (kStep * kStep);
  kinematics(model, w, x);
  Eigen::MatrixXd H;
  marker_normal_matrix(model, w, weight, H);
  descent_at(x);
  subtract_force_curvature(model, w, H);
  EXPECT_NEAR(d.dot(H * d), expected, 2e-6 * std::max(1.0, std::abs(expected)));
}

TEST(AddForce, GroundTakesItWithoutEffectAndBodiesAsVirtualWorkSays) {
  const Model model = Model::compile(random_tree(1)).value();
  Workspace w(model);
  Random random(9, 9);
  kinematics(model, w, random_state(model, random));
  const int body = static_cast<int>(model.bodies().size()) - 1;
  const Vector3d p = point_in_world(w, body, {0.1, 0.2, 0.3}), force(1.0, -2.0, 3.0);
  clear_forces(w);
  add_force(w, data::kGround, p, force);
  add_force(w, body, p, force);
  VectorXd g;
  project_forces(model, w, g);
  Eigen::MatrixXd J(3, model.speed_count());
  point_jacobian(model, w, body, p, J);
  EXPECT_LT((g - J.transpose() * force).norm(), 1e-13);
}

}  // namespace
}  // namespace kinemark::model
