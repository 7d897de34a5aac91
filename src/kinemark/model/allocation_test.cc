// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"
#include "kinemark/model/weighted_normal.h"
#include "support/allocations.h"

namespace kinemark::model {
namespace {

TEST(Allocations, NothingIsAllocatedPerCall) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const Model model = Model::compile(testing::random_tree(3)).value();
  Workspace w(model);
  Random random(5, 0);
  const VectorXd v = testing::random_vector(model.speed_count(), 1.0, random);
  const VectorXd weight = VectorXd::Ones(model.marker_count());
  const Eigen::Matrix3Xd residual = Eigen::Matrix3Xd::Constant(3, model.marker_count(), 0.01);
  VectorXd x = testing::random_state(model, random), dv, q, near = VectorXd::Zero(model.coordinate_count());
  VectorXd b, g, bias, gap;
  const VectorXd start = x;
  Eigen::MatrixXd M, J, C, E, H;
  const auto everything = [&] {
    kinematics(model, w, x);
    velocities(model, w, v);
    mass_matrix(model, w, M);
    bias_forces(model, w, b);
    gravity_forces(model, w, g);
    const double energy = kinetic_energy(model, w) + potential_energy(model, w);
    marker_jacobian(model, w, J);
    marker_bias_acceleration(model, w, bias);
    point_constraint_gaps(model, w, gap);
    point_constraint_jacobian(model, w, C);
    coordinates_from_state(model, x, near, q);
    coordinate_jacobian(model, w, q, E);
    marker_normal_matrix(model, w, weight, H);
    clear_forces(w);
    add_marker_forces(model, w, weight, residual);
    project_forces(model, w, g);
    subtract_force_curvature(model, w, H);
    integrate(model, x, v);
    difference(model, start, x, dv);
    return energy;
  };
  everything();  // sizes the results
  const auto before = testing_support::allocations_on_this_thread();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(std::isfinite(everything()));
  EXPECT_EQ(testing_support::allocations_on_this_thread() - before, 0);
}

}  // namespace
}  // namespace kinemark::model
