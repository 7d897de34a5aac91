// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/controller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"
#include "support/allocations.h"

namespace kinemark::motion::internal {
namespace {

model::Model body(double range = 2.5) {
  auto description = testing_body::description();
  for (auto& c : description.coordinates)
    if (c.clamped) c.range_min = -range, c.range_max = range;
  return model::Model::compile(std::move(description)).value();
}

Plan make(const model::Model& model, const TrackOptions& options) {
  return make_plan(model, testing_body::record(model, 4), options).value();
}

/// Goals where the model's markers are in state x, at rest.
GoalValues goals_at(const Plan& plan, const Eigen::VectorXd& x) {
  model::Workspace w(plan.problem.model);
  model::kinematics(plan.problem.model, w, x);
  GoalValues goal(plan.problem.model.marker_count());
  goal.x = w.marker;
  goal.weight.setOnes();
  return goal;
}

Eigen::VectorXd pose(const Plan& plan, std::int64_t frame) {
  return model::state_from_coordinates(plan.problem.model,
                                       testing_body::coordinates(plan.problem.model, frame));
}

double distance(const Plan& plan, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd way;
  model::difference(plan.problem.model, a, b, way);
  return way.norm();
}

TEST(Controller, ComesToRestAtGoalsThatItCanReach) {
  const auto model = body();
  const Plan plan = make(model, {.step_s = 1e-3, .damping = 0.0});
  Controller controller(plan);
  const auto there = pose(plan, 10);
  const auto goal = goals_at(plan, there);
  controller.start(pose(plan, 0), goal, 0.0);
  for (int s = 0; s < 300; ++s) {
    ASSERT_TRUE(controller.evaluate(goal, 0.001 * s));
    controller.advance(1e-3);
  }
  EXPECT_LT(distance(plan, controller.x(), there), 1e-8);
  EXPECT_LT(controller.v().norm(), 1e-6);
}

TEST(Controller, GoesBackToTheStateThatWasKept) {
  const auto model = body();
  const Plan plan = make(model, {.step_s = 1e-3});
  Controller controller(plan);
  const auto goal = goals_at(plan, pose(plan, 10));
  controller.start(pose(plan, 0), goal, 0.0);
  const auto go_on = [&] {
    for (int s = 0; s < 5; ++s) {
      controller.advance(1e-3);
      ASSERT_TRUE(controller.evaluate(goal, 0.0));
    }
  };
  ASSERT_TRUE(controller.evaluate(goal, 0.0));
  go_on();
  const Eigen::VectorXd x = controller.x(), v = controller.v();
  const Eigen::Matrix3Xd markers = controller.workspace().marker;
  controller.keep();
  go_on();
  const Eigen::VectorXd later = controller.x();
  EXPECT_GT(distance(plan, x, later), 1e-4);
  controller.go_back();
  EXPECT_EQ(controller.x(), x);
  EXPECT_EQ(controller.v(), v);
  EXPECT_EQ(controller.workspace().marker, markers);
  go_on();
  EXPECT_EQ(controller.x(), later) << "the same way again";
}

TEST(Controller, TheFastWayAndTheRowsAgree) {
  const auto model = body();
  const Plan fast = make(model, {});
  // Naming the same markers in one level and none in a second closes the fast way.
  Plan rows = make(model, {});
  rows.levels.emplace_back();
  Controller a(fast), b(rows);
  const auto goal = goals_at(fast, pose(fast, 5));
  a.start(pose(fast, 0), goal, 0.0);
  b.start(pose(rows, 0), goal, 0.0);
  ASSERT_TRUE(a.evaluate(goal, 0.0) && b.evaluate(goal, 0.0));
  EXPECT_LT((a.a() - b.a()).norm(), 1e-8 * a.a().norm());
  EXPECT_EQ(a.rank(), b.rank());
}

TEST(Controller, AnExactLevelGetsTheAccelerationItAsksFor) {
  const auto model = body();
  const Plan plan = make(
      model, {.levels = {{.markers = {"F2"}}, {.markers = {"S2", "T3"}}}, .strict = true, .damping = 0.0});
  Controller controller(plan);
  auto goal = goals_at(plan, pose(plan, 3));
  goal.a.col(0) = Eigen::Vector3d(1.0, -2.0, 0.5);
  controller.start(pose(plan, 0), goal, 0.0);
  ASSERT_TRUE(controller.evaluate(goal, 0.0));
  auto& w = controller.workspace();
  const auto& marker = plan.problem.model.markers();
  Eigen::MatrixXd J;
  Eigen::VectorXd bias;
  model::marker_jacobian(plan.problem.model, w, J);
  model::marker_bias_acceleration(plan.problem.model, w, bias);
  const Eigen::VectorXd a = J * controller.a() + bias;
  for (std::size_t i = 0; i < plan.levels.size(); ++i)
    for (const int m : plan.levels[i].markers) {
      const Eigen::Vector3d at = w.marker.col(m);
      const Eigen::Vector3d v = model::point_velocity(w, marker[static_cast<std::size_t>(m)].body, at);
      const Eigen::Vector3d asked =
          goal.a.col(m) + plan.kd * (goal.v.col(m) - v) + plan.kp * (goal.x.col(m) - at);
      EXPECT_LT((a.segment<3>(3 * m) - asked).norm(), 1e-7 * asked.norm()) << m;
    }
  EXPECT_EQ(controller.rank(), 9);
}

TEST(Controller, LimitsHoldAndNothingIsFasterThanTheySay) {
  const auto model = body(0.4);
  const Plan plan = make(model, {.step_s = 1e-3});
  Controller controller(plan);
  // Goals of a body without these limits: elbow and knee exceed them by far.
  Eigen::VectorXd q = Eigen::VectorXd::Zero(13);
  q[9] = 1.2;
  q[11] = -1.2;
  const auto goal = goals_at(plan, model::state_from_coordinates(plan.problem.model, q));
  controller.start(plan.rest, goal, 0.0);
  double highest = 0.0;
  const auto coordinates = plan.problem.model.coordinates();
  for (int s = 0; s < 500; ++s) {
    ASSERT_TRUE(controller.evaluate(goal, 0.001 * s));
    controller.advance(1e-3);
    for (const auto& c : coordinates) {
      if (c.speed_idx < 0) continue;
      highest = std::max(highest, std::abs(controller.x()[c.state_idx]));
      ASSERT_LE(std::abs(controller.x()[c.state_idx]), 0.4);
    }
  }
  EXPECT_GT(highest, 0.399);
  EXPECT_LT(controller.v().norm(), 1e-3);
}

TEST(Controller, PostureFillsWhatNoGoalFixes) {
  const auto model = body();
  Plan plan =
      make(model, {.levels = {{.markers = {"T1", "T2", "T3", "T4"}}}, .step_s = 1e-3, .lock = LockMode::off});
  Eigen::VectorXd q = Eigen::VectorXd::Zero(13);
  q[9] = 0.7;
  plan.rest = model::state_from_coordinates(plan.problem.model, q);
  Controller controller(plan);
  const auto goal = goals_at(plan, plan.rest);
  controller.start(pose(plan, 0), goal, 0.0);
  for (int s = 0; s < 1500; ++s) {
    ASSERT_TRUE(controller.evaluate(goal, 0.001 * s));
    controller.advance(1e-3);
  }
  EXPECT_EQ(controller.rank(), 6);
  EXPECT_LT(distance(plan, controller.x(), plan.rest), 1e-4);
}

TEST(Controller, LockedSpeedsStayWhereTheyAre) {
  const auto model = body();
  const Plan plan = make(model, {.step_s = 1e-3, .locked = {"elbow"}});
  Controller controller(plan);
  auto x = pose(plan, 0);
  plan.apply_locks(x);
  const auto goal = goals_at(plan, pose(plan, 20));
  controller.start(x, goal, 0.0);
  const int row = plan.problem.model.coordinates()[9].state_idx;
  for (int s = 0; s < 50; ++s) {
    ASSERT_TRUE(controller.evaluate(goal, 0.0));
    controller.advance(1e-3);
    ASSERT_EQ(controller.x()[row], plan.rest[row]);
  }
}

TEST(Controller, SaysWhenTheBodyRunsAway) {
  const auto model = body();
  const Plan plan = make(model, {.step_s = 1e-3});
  Controller controller(plan);
  auto goal = goals_at(plan, pose(plan, 0));
  controller.start(pose(plan, 0), goal, 0.0);
  goal.x.col(0).x() += 1e6;
  bool fine = true;
  for (int s = 0; fine && s < 20; ++s) {
    fine = controller.evaluate(goal, 0.0);
    controller.advance(1e-3);
  }
  EXPECT_FALSE(fine);
}

TEST(Controller, AStepAllocatesNothing) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const auto model = body(0.9);  // some limits are met on the way
  for (const bool two_levels : {false, true}) {
    TrackOptions options{.step_s = 1e-3};
    if (two_levels)
      options.levels = {{.markers = {"T1", "T2", "T3", "T4"}}, {.markers = {"*"}}}, options.strict = true;
    const Plan plan = make(model, options);
    Controller controller(plan);
    const auto goal = goals_at(plan, pose(plan, 30));
    controller.start(plan.rest, goal, 0.0);
    const auto step = [&] {
      controller.evaluate(goal, 0.0);
      controller.advance(1e-3);
    };
    for (int s = 0; s < 10; ++s) step();
    const auto before = testing_support::allocations_on_this_thread();
    for (int s = 0; s < 100; ++s) step();
    controller.push({.body = 2, .force_in_world = {40.0, -30.0, 20.0}});
    for (int s = 0; s < 100; ++s) step();
    EXPECT_EQ(testing_support::allocations_on_this_thread(), before) << two_levels;
  }
}

}  // namespace
}  // namespace kinemark::motion::internal
