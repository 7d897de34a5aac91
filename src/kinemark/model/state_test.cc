// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using Eigen::MatrixXd;
using testing::random_state;
using testing::random_tree;
using testing::random_vector;
using testing::relative_error;

TEST(State, CoordinatesComeBack) {
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const bool free_roots : {true, false}) {
      const Model model = Model::compile(random_tree(seed), {.free_roots = free_roots}).value();
      Random random(seed, 10);
      const VectorXd q = random_vector(model.coordinate_count(), 1.2, random);
      VectorXd back;
      coordinates_from_state(model, state_from_coordinates(model, q), q, back);
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& coordinate = model.coordinates()[static_cast<std::size_t>(c)];
        const auto& described = model.description().coordinates[static_cast<std::size_t>(c)];
        if (coordinate.source >= 0)
          EXPECT_EQ(back[c], coordinate.coupling(back[coordinate.source]).f) << described.name;
        else if (described.name == "idle")
          EXPECT_EQ(back[c], described.default_value);
        else
          EXPECT_NEAR(back[c], q[c], 1e-13) << described.name;
      }
    }
}

TEST(State, AnglesStayContinuousOverFullTurns) {
  const Model model = Model::compile(random_tree(2)).value();
  const auto& free = model.free_joints()[0];
  VectorXd q = VectorXd::Zero(model.coordinate_count()), near = q, back;
  // Two turns and a half about the first axis while the others sway; the middle one stays below 90 degrees.
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    q[free.rotation_coordinate[0]] = 5.0 * std::numbers::pi * s;
    q[free.rotation_coordinate[1]] = 1.4 * std::sin(9.0 * s);
    q[free.rotation_coordinate[2]] = -3.0 * std::numbers::pi * s;
    coordinates_from_state(model, state_from_coordinates(model, q), near, back);
    for (const int c : free.rotation_coordinate) ASSERT_NEAR(back[c], q[c], 1e-9) << "step " << i;
    near = back;
  }
}

TEST(State, PassesThroughTheSingularAttitude) {
  // Exactly at 90 degrees, and near it, the angles returned must still describe the same rotation.
  const Model model = Model::compile(random_tree(4)).value();
  const auto& free = model.free_joints()[0];
  for (const double off : {0.0, 1e-12, 1e-8, 1e-4, -1e-9}) {
    VectorXd q = VectorXd::Constant(model.coordinate_count(), 0.3), back;
    q[free.rotation_coordinate[1]] = std::numbers::pi / 2.0 + off;
    const VectorXd x = state_from_coordinates(model, q);
    coordinates_from_state(model, x, q, back);
    VectorXd dv;
    difference(model, x, state_from_coordinates(model, back), dv);
    EXPECT_LT(dv.norm(), 1e-8) << off;
    EXPECT_TRUE(back.allFinite());
    for (const int c : free.rotation_coordinate) EXPECT_NEAR(back[c], q[c], 1e-3) << off;
  }
}

TEST(State, DifferenceInvertsIntegrate) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Model model = Model::compile(random_tree(seed)).value();
    Random random(seed, 11);
    const VectorXd from = random_state(model, random);
    for (const double size : {0.0, 1e-13, 1e-6, 1.7}) {  // 1.7 * sqrt(3) < pi
      const VectorXd dv = random_vector(model.speed_count(), size, random);
      VectorXd to = from, back;
      integrate(model, to, dv);
      difference(model, from, to, back);
      EXPECT_LT((back - dv).norm(), 1e-14 + 1e-13 * size * 10.0);
      EXPECT_NEAR(to.segment<4>(model.free_joints()[0].state_idx + 3).norm(), 1.0, 1e-15);
    }
  }
}

TEST(State, CoordinateJacobianIsTheSlopeOfTheCoordinates) {
  constexpr double kStep = 1e-5;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const bool free_roots : {true, false}) {
      const Model model = Model::compile(random_tree(seed), {.free_roots = free_roots}).value();
      Workspace w(model);
      Random random(seed, 12);
      const VectorXd q0 = random_vector(model.coordinate_count(), 1.0, random);
      const VectorXd x = state_from_coordinates(model, q0);
      VectorXd q, ahead, behind;
      MatrixXd expected(model.coordinate_count(), model.speed_count()), E;
      for (int i = 0; i < model.speed_count(); ++i) {
        VectorXd moved = x;
        integrate(model, moved, kStep * VectorXd::Unit(model.speed_count(), i));
        coordinates_from_state(model, moved, q0, ahead);
        moved = x;
        integrate(model, moved, -kStep * VectorXd::Unit(model.speed_count(), i));
        coordinates_from_state(model, moved, q0, behind);
        expected.col(i) = (ahead - behind) / (2.0 * kStep);
      }
      coordinates_from_state(model, x, q0, q);
      kinematics(model, w, x);
      coordinate_jacobian(model, w, q, E);
      EXPECT_LT(relative_error(E, expected), 1e-7);
    }
}

TEST(State, CoupledSlopesAreExact) {
  const Model model = Model::compile(random_tree(6)).value();
  Workspace w(model);
  Random random(6, 13);
  const VectorXd x = random_state(model, random);
  kinematics(model, w, x);
  MatrixXd E;
  coordinate_jacobian(model, w, w.q, E);
  const auto& d = model.description();
  const int knee = d.find_coordinate("knee"), first = d.find_coordinate("chain1"),
            second = d.find_coordinate("chain2");
  const auto f = model.coordinates()[static_cast<std::size_t>(first)].coupling(w.q[knee]);
  const auto g = model.coordinates()[static_cast<std::size_t>(second)].coupling(f.f);
  const int speed = model.coordinates()[static_cast<std::size_t>(knee)].speed_idx;
  EXPECT_EQ(w.q[second], g.f);
  EXPECT_EQ(E(first, speed), f.df);
  EXPECT_EQ(E(second, speed), g.df * f.df);
  EXPECT_NEAR(w.q_curvature[second], g.ddf * f.df * f.df + g.df * f.ddf, 1e-15);
}

TEST(State, RefusesWrongSizes) {
  const Model model = Model::compile(random_tree(0)).value();
  VectorXd x = model.default_state(), q;
  EXPECT_THROW(integrate(model, x, VectorXd::Zero(3)), ContractError);
  EXPECT_THROW((void)state_from_coordinates(model, VectorXd::Zero(3)), ContractError);
  EXPECT_THROW(coordinates_from_state(model, x, VectorXd::Zero(3), q), ContractError);
}

}  // namespace
}  // namespace kinemark::model
