// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/coordinate_rates.h"

#include <gtest/gtest.h>

#include "kinemark/core/check.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using testing::random_tree;
using testing::random_vector;
using testing::relative_error;

/// Coordinates that move along a parabola in time; coupled ones follow.
struct Path {
  const Model& model;
  VectorXd q0, qd, qdd;

  [[nodiscard]] VectorXd state_at(double t) const {
    return state_from_coordinates(model, q0 + t * qd + 0.5 * t * t * qdd);
  }
  /// Speeds at time t by the manifold's own difference, fourth order.
  [[nodiscard]] VectorXd speeds_at(double t) const {
    const double h = 1e-4;
    VectorXd near_one, far_one, near_back, far_back;
    difference(model, state_at(t), state_at(t + h), near_one);
    difference(model, state_at(t), state_at(t + 2 * h), far_one);
    difference(model, state_at(t), state_at(t - h), near_back);
    difference(model, state_at(t), state_at(t - 2 * h), far_back);
    return (8.0 * (near_one - near_back) - (far_one - far_back)) / (12.0 * h);
  }
};

TEST(CoordinateRates, SpeedsAreTheSlopeOfTheState) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Model model = Model::compile(random_tree(seed)).value();
    Random random(seed, 41);
    const VectorXd q0 = random_vector(model.coordinate_count(), 1.0, random),
                   qd = random_vector(model.coordinate_count(), 2.0, random),
                   qdd = random_vector(model.coordinate_count(), 8.0, random);
    const Path path{model, q0, qd, qdd};
    VectorXd v, vdot;
    speeds_from_rates(model, q0, qd, qdd, v, vdot);
    EXPECT_LT(relative_error(v, path.speeds_at(0.0)), 1e-8) << "seed " << seed;
    const double h = 1e-3;
    const VectorXd slope =
        (8.0 * (path.speeds_at(h) - path.speeds_at(-h)) - (path.speeds_at(2 * h) - path.speeds_at(-2 * h))) /
        (12.0 * h);
    EXPECT_LT(relative_error(vdot, slope), 1e-6) << "seed " << seed;
  }
}

TEST(CoordinateRates, ComeBackFromTheSpeeds) {
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const bool free_roots : {true, false}) {
      const Model model = Model::compile(random_tree(seed), {.free_roots = free_roots}).value();
      Random random(seed, 42);
      const VectorXd q = random_vector(model.coordinate_count(), 1.0, random),
                     qd = random_vector(model.coordinate_count(), 2.0, random),
                     qdd = random_vector(model.coordinate_count(), 8.0, random);
      VectorXd v, vdot, qd_back, qdd_back;
      speeds_from_rates(model, q, qd, qdd, v, vdot);
      Workspace w(model);
      kinematics(model, w, state_from_coordinates(model, q));
      rates_from_speeds(model, w, q, v, vdot, qd_back, qdd_back);
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& coordinate = model.coordinates()[static_cast<std::size_t>(c)];
        if (coordinate.speed_idx < 0 && coordinate.free_joint < 0) continue;  // coupled, or drives nothing
        EXPECT_NEAR(qd_back[c], qd[c], 1e-11);
        EXPECT_NEAR(qdd_back[c], qdd[c], 1e-10);
      }
    }
}

TEST(CoordinateRates, CoupledCoordinatesFollowTheirSource) {
  const Model model = Model::compile(random_tree(1)).value();
  Random random(5, 43);
  VectorXd q = random_vector(model.coordinate_count(), 0.8, random);
  Workspace w(model);
  kinematics(model, w, state_from_coordinates(model, q));
  q = w.q;
  const VectorXd v = random_vector(model.speed_count(), 1.5, random),
                 vdot = random_vector(model.speed_count(), 4.0, random);
  VectorXd qd, qdd;
  rates_from_speeds(model, w, q, v, vdot, qd, qdd);
  int coupled = 0;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& coordinate = model.coordinates()[static_cast<std::size_t>(c)];
    if (coordinate.source < 0) continue;
    ++coupled;
    const auto f = coordinate.coupling(q[coordinate.source]);
    const double source_rate = qd[coordinate.source];
    EXPECT_NEAR(qd[c], f.df * source_rate, 1e-12);
    EXPECT_NEAR(qdd[c], f.df * qdd[coordinate.source] + f.ddf * source_rate * source_rate, 1e-10);
  }
  EXPECT_GT(coupled, 0);
}

TEST(CoordinateRates, RefuseWrongSizes) {
  const Model model = Model::compile(random_tree(1)).value();
  VectorXd v, vdot;
  EXPECT_THROW(speeds_from_rates(model, VectorXd::Zero(1), VectorXd::Zero(1), VectorXd::Zero(1), v, vdot),
               ContractError);
}

}  // namespace
}  // namespace kinemark::model
