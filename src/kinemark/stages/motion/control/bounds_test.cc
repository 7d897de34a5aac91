// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bounds of tracked coordinates against small changes of the goals, one after the other.
#include "kinemark/stages/motion/control/internal/bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kElbow = 9, kKnee = 11;
constexpr double kSmall_m = 1e-5;  // moves the body so little that the first order is all

/// The body in a pose, with goals for its markers.
struct Tracked {
  explicit Tracked(data::ModelDescription description = testing_body::description(),
                   const TrackOptions& options = {})
      : model(model::Model::compile(std::move(description)).value()),
        plan(make_plan(model, testing_body::record(model, 4), options).value()),
        q(testing_body::coordinates(plan.problem.model, 1)),
        x(model::state_from_coordinates(plan.problem.model, q)),
        goal(plan.problem.model.marker_count()),
        bounds(plan) {
    reach(x);
    goal.weight.setOnes();
    noise.own.setZero(plan.problem.model.marker_count());
    noise.common.setZero(static_cast<Eigen::Index>(plan.problem.model.bodies().size()));
  }
  /// Goals where the markers are in state `there`.
  void reach(const VectorXd& there) {
    model::Workspace w(plan.problem.model);
    model::kinematics(plan.problem.model, w, there);
    goal.x = w.marker;
  }
  void find() { bounds.find(x, q, goal, 0.0, noise); }
  /// Change of each coordinate by a change of the goals, as equation 15 has it.
  VectorXd lag_of(const Eigen::Matrix3Xd& change) {
    const GoalValues kept = goal;
    const MarkerVariances known = noise;
    noise.own.setZero();
    noise.common.setZero();
    goal.x += change;
    find();
    goal = kept;
    noise = known;
    return bounds.bound();
  }
  [[nodiscard]] int count() const { return plan.problem.model.coordinate_count(); }

  model::Model model;
  Plan plan;
  VectorXd q, x;
  GoalValues goal;
  MarkerVariances noise;
  Bounds bounds;
};

TEST(Bounds, GoalsThatAreReachedExactlyLeaveNothing) {
  Tracked t;
  t.find();
  EXPECT_EQ(t.bounds.rank(), t.plan.problem.model.speed_count());
  EXPECT_GT(t.bounds.smallest_singular(), 0.0);
  for (int c = 0; c < t.count(); ++c) {
    EXPECT_TRUE(t.bounds.determined()[static_cast<std::size_t>(c)]) << c;
    EXPECT_LT(t.bounds.bound()[c], 1e-12) << c;
    EXPECT_LT(t.bounds.goal_bound()[c], 1e-12) << c;
  }
}

TEST(Bounds, OfGoalsOnTheWayTheyAreTheWay) {
  Tracked t;
  VectorXd move(t.plan.problem.model.speed_count());
  for (Eigen::Index k = 0; k < move.size(); ++k) move[k] = 1e-5 * (1.0 + 0.3 * static_cast<double>(k));
  VectorXd there = t.x, q_there = t.q;
  model::integrate(t.plan.problem.model, there, move);
  model::coordinates_from_state(t.plan.problem.model, there, t.q, q_there);
  t.reach(there);
  t.find();
  for (int c = 0; c < t.count(); ++c) {
    const double way = std::abs(q_there[c] - t.q[c]);
    EXPECT_NEAR(t.bounds.bound()[c], way, 1e-3 * way + 1e-10) << c;
    EXPECT_GE(t.bounds.goal_bound()[c], t.bounds.bound()[c] * (1.0 - 1e-9)) << "equation 16 is the wider one";
    EXPECT_NEAR(t.bounds.sd()[c], t.bounds.bound()[c], 1e-7) << "without noise the error alone";
  }
}

TEST(Bounds, EquationFifteenHasTheSignOfTheWay) {
  Tracked t;
  VectorXd move = VectorXd::Zero(t.plan.problem.model.speed_count()), there = t.x;
  const int elbow = t.plan.problem.model.coordinates()[kElbow].speed_idx;
  move[elbow] = -1e-5;
  model::integrate(t.plan.problem.model, there, move);
  t.reach(there);
  t.find();
  EXPECT_NEAR(t.bounds.goal_error()[kElbow], -1e-5, 1e-8);
  EXPECT_NEAR(t.bounds.goal_error()[kKnee], 0.0, 1e-9);
}

/// Goals that no pose reaches, off by 10 mm each, and where least squares has the body then.
struct Unreachable : Tracked {
  Unreachable() {
    Random random(5, 1);
    for (Eigen::Index m = 0; m < goal.x.cols(); ++m)
      for (int axis = 0; axis < 3; ++axis) goal.x(axis, m) += 0.01 * random.gaussian();
    solve();
  }
  void solve() {
    IkOptions options = plan.start_options;
    options.max_iterations = 200;
    fitted = x;
    Problem unbiased = plan.problem;
    unbiased.coordinate_tasks.clear();
    FrameSolver(unbiased, options).solve(goal.x, goal.weight, 0, fitted);
    q_fitted = q;
    model::coordinates_from_state(plan.problem.model, fitted, q, q_fitted);
  }
  /// The body some degrees from the best fit.
  void move_off(double rad) {
    VectorXd move(plan.problem.model.speed_count());
    for (Eigen::Index k = 0; k < move.size(); ++k) move[k] = k < 3 ? 0.1 * rad : (k % 2 == 0 ? rad : -rad);
    x = fitted;
    model::integrate(plan.problem.model, x, move);
    model::coordinates_from_state(plan.problem.model, x, q_fitted, q);
  }
  VectorXd fitted, q_fitted;
};

TEST(Bounds, TheWayToGoalsThatNoPoseReachesIsFoundAllTheSame) {
  Unreachable t;
  for (const double rad : {0.01, 0.05, 0.15}) {
    t.move_off(rad);
    t.find();
    const VectorXd way = t.q_fitted - t.q;
    for (int c = 0; c < t.count(); ++c) {
      ASSERT_TRUE(t.bounds.determined()[static_cast<std::size_t>(c)]) << c;
      EXPECT_NEAR(t.bounds.goal_error()[c], way[c], 1e-6) << c << ", " << rad;
      EXPECT_LE(std::abs(way[c]), t.bounds.bound()[c] + 1e-6) << c;
      EXPECT_LE(std::abs(way[c]), t.bounds.goal_bound()[c] + 1e-6) << c << ": equation 16 is no narrower";
    }
  }
}

TEST(Bounds, TheWayEndsAtALimit) {
  Unreachable t;
  const auto& elbow = t.plan.problem.model.coordinates()[kElbow];
  t.plan.problem.upper[elbow.speed_idx] = t.fitted[elbow.state_idx] - 0.02;
  t.solve();
  ASSERT_NEAR(t.fitted[elbow.state_idx], t.plan.problem.upper[elbow.speed_idx], 1e-9);
  t.move_off(-0.05);
  t.x[elbow.state_idx] = t.q[kElbow] = t.plan.problem.upper[elbow.speed_idx] - 0.05;
  t.find();
  for (int c = 0; c < t.count(); ++c)
    EXPECT_NEAR(t.bounds.goal_error()[c], t.q_fitted[c] - t.q[c], 1e-6) << c;
}

TEST(Bounds, WhereNoBestFitIsFoundEquationSixteenStandsForTheWay) {
  Tracked t;
  t.goal.x *= 1e6;  // a thousand kilometres away
  t.find();
  for (int c = 0; c < t.count(); ++c) {
    EXPECT_TRUE(std::isnan(t.bounds.goal_error()[c])) << c;
    if (t.bounds.determined()[static_cast<std::size_t>(c)])
      EXPECT_EQ(t.bounds.bound()[c], t.bounds.goal_bound()[c]) << c << ": the goals have no noise";
    else
      EXPECT_TRUE(std::isnan(t.bounds.bound()[c])) << c;
  }
  EXPECT_FALSE(t.bounds.determined()[kElbow]) << "as far as that";
}

TEST(Bounds, PressedAgainstALimitACoordinateIsWhereItsGoalsAskForIt) {
  Tracked t;
  const auto& elbow = t.plan.problem.model.coordinates()[kElbow];
  VectorXd move = VectorXd::Zero(t.plan.problem.model.speed_count()), there = t.x;
  move[elbow.speed_idx] = 0.01;
  model::integrate(t.plan.problem.model, there, move);
  t.reach(there);
  t.find();
  EXPECT_NEAR(t.bounds.goal_error()[kElbow], 0.01, 1e-3) << "it is free";
  const VectorXd sd = t.bounds.sd();
  t.plan.problem.upper[elbow.speed_idx] = t.x[elbow.state_idx];
  t.find();
  EXPECT_EQ(t.bounds.goal_error()[kElbow], 0.0);
  EXPECT_EQ(t.bounds.goal_bound()[kElbow], 0.0);
  EXPECT_TRUE(t.bounds.determined()[kElbow]);
  EXPECT_EQ(t.bounds.rank(), t.plan.problem.model.speed_count()) << "the markers determine it all the same";
  // The others are not asked to make up for it beyond what the limit leaves them.
  EXPECT_NE(t.bounds.goal_error()[kElbow - 1], 0.0);
  t.plan.problem.upper[elbow.speed_idx] = t.x[elbow.state_idx] + 1.0;
  t.plan.problem.lower[elbow.speed_idx] = t.x[elbow.state_idx];
  t.find();
  EXPECT_NEAR(t.bounds.goal_error()[kElbow], 0.01, 1e-3) << "its goals lie on the free side";
}

TEST(Bounds, NoiseOfEachMarkerAddsInSquares) {
  Tracked t;
  for (Eigen::Index m = 0; m < t.noise.own.size(); ++m)
    t.noise.own[m] = 1e-6 * (1.0 + static_cast<double>(m));
  t.find();
  const VectorXd sd = t.bounds.sd(), bound = t.bounds.bound();
  VectorXd variance = VectorXd::Zero(t.count());
  for (Eigen::Index m = 0; m < t.noise.own.size(); ++m)
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix3Xd change = Eigen::Matrix3Xd::Zero(3, t.noise.own.size());
      change(axis, m) = kSmall_m;
      variance += t.noise.own[m] * (t.lag_of(change) / kSmall_m).cwiseAbs2();
    }
  for (int c = 0; c < t.count(); ++c) {
    EXPECT_NEAR(sd[c] / std::sqrt(variance[c]), 1.0, 1e-3) << c;
    EXPECT_NEAR(bound[c] / sd[c], Bounds::kNoiseSds, 1e-6) << c;
  }
}

TEST(Bounds, WhatTheMarkersOfABodyShareMovesThemTogether) {
  Tracked t;
  const auto markers = t.plan.problem.model.markers();
  const int shank = markers[10].body;
  t.noise.common[shank] = 4e-6;
  t.find();
  const VectorXd sd = t.bounds.sd();
  VectorXd variance = VectorXd::Zero(t.count());
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3Xd change = Eigen::Matrix3Xd::Zero(3, t.noise.own.size());
    for (Eigen::Index m = 0; m < change.cols(); ++m)
      if (markers[static_cast<std::size_t>(m)].body == shank) change(axis, m) = kSmall_m;
    variance += 4e-6 * (t.lag_of(change) / kSmall_m).cwiseAbs2();
  }
  for (int c = 0; c < t.count(); ++c) EXPECT_NEAR(sd[c], std::sqrt(variance[c]), 1e-9 + 1e-3 * sd[c]) << c;
}

TEST(Bounds, WhatNoGoalFixesIsUnknownAndOnlyThat) {
  Tracked t;
  t.noise.own.setConstant(1e-6);
  for (const Eigen::Index m : {6, 7}) t.goal.weight[m] = 0.0;  // the forearm's
  t.find();
  EXPECT_EQ(t.bounds.rank(), t.plan.problem.model.speed_count() - 1);
  for (int c = 0; c < t.count(); ++c) {
    EXPECT_EQ(t.bounds.determined()[static_cast<std::size_t>(c)], c != kElbow) << c;
    for (const VectorXd* v : {&t.bounds.sd(), &t.bounds.bound(), &t.bounds.goal_bound()})
      EXPECT_EQ(std::isnan((*v)[c]), c == kElbow) << c;
  }
  t.goal.weight.setZero();
  t.find();
  EXPECT_EQ(t.bounds.rank(), 0);
  EXPECT_EQ(t.bounds.smallest_singular(), 0.0);
  for (int c = 0; c < t.count(); ++c) EXPECT_TRUE(std::isnan(t.bounds.sd()[c])) << c;
}

TEST(Bounds, AllWeightsAlikeAreAsGoodAsOne) {
  Tracked t;
  t.noise.own.setConstant(1e-6);
  t.find();
  const VectorXd sd = t.bounds.sd();
  t.goal.weight.setConstant(0.25);
  t.find();
  EXPECT_TRUE(t.bounds.sd().isApprox(sd, 1e-9));
}

TEST(Bounds, ALockedCoordinateIsKnownFromTheModelAndOneLockedHereIsNot) {
  auto description = testing_body::description();
  description.coordinates[kElbow].locked = true;
  Tracked locked(description);
  locked.noise.own.setConstant(1e-6);
  locked.find();
  EXPECT_EQ(locked.bounds.rank(), locked.plan.problem.model.speed_count() - 1);
  EXPECT_TRUE(locked.bounds.determined()[kElbow]);
  EXPECT_EQ(locked.bounds.sd()[kElbow], 0.0);
  Tracked here;
  here.noise.own.setConstant(1e-6);
  here.plan.locked = {kElbow};
  here.find();
  EXPECT_FALSE(here.bounds.determined()[kElbow]);
  EXPECT_TRUE(std::isnan(here.bounds.bound()[kElbow]));
  EXPECT_TRUE(here.bounds.determined()[kKnee]);
}

TEST(Bounds, ErrorsThatAPoseExplainsAreCoordinatesAndNothingElse) {
  Tracked t;
  t.find();
  const auto& model = t.plan.problem.model;
  model::Workspace w(model);
  model::kinematics(model, w, t.x);
  const Eigen::Matrix3Xd before = w.marker;
  VectorXd move = VectorXd::Zero(model.speed_count()), there = t.x, q = t.q, squares, freedom;
  for (Eigen::Index k = 6; k < move.size(); ++k) move[k] = 1e-6 * static_cast<double>(k);
  model::integrate(model, there, move);
  model::kinematics(model, w, there);
  model::coordinates_from_state(model, there, t.q, q);
  const Eigen::Matrix3Xd error = w.marker - before;
  const VectorXd found = t.bounds.coordinates_of(error);
  for (int c = 0; c < t.count(); ++c) EXPECT_NEAR(found[c], q[c] - t.q[c], 1e-9) << c << ": to first order";
  t.bounds.unexplained(error, squares, freedom);
  EXPECT_LT(squares.maxCoeff(), 1e-8 * error.squaredNorm());
  EXPECT_NEAR(freedom.sum(), 3.0 * static_cast<double>(error.cols()) - t.bounds.rank(), 1e-9);
  // A marker that is no goal explains nothing, and nothing is asked of it.
  t.goal.weight[0] = 0.0;
  t.find();
  t.bounds.unexplained(error, squares, freedom);
  EXPECT_EQ(squares[0], 0.0);
  EXPECT_EQ(freedom[0], 0.0);
}

TEST(Bounds, VarianceOfIndependentErrorsIsThatOfTheirNoise) {
  Tracked t;
  for (Eigen::Index m = 0; m < t.noise.own.size(); ++m)
    t.noise.own[m] = 1e-6 * (1.0 + static_cast<double>(m));
  t.goal.weight[3] = 0.3;
  t.find();
  const VectorXd variance = t.bounds.variance_of(t.noise.own);
  for (int c = 0; c < t.count(); ++c) EXPECT_NEAR(std::sqrt(variance[c]), t.bounds.sd()[c], 1e-9) << c;
}

}  // namespace
}  // namespace kinemark::motion::internal
