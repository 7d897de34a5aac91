// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/tasks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"
#include "support/allocations.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// Velocity and bias of a task against differences of its error along a motion x(t) with speeds v + a t.
void expect_consistent(const model::Model& model, Task& task, double tolerance) {
  ASSERT_TRUE(task.bind(model));
  model::Workspace w(model);
  const int n = model.speed_count();
  const Eigen::VectorXd x0 = model::state_from_coordinates(model, testing_body::coordinates(model, 40));
  Eigen::VectorXd v(n), a(n);
  for (int k = 0; k < n; ++k) {
    v[k] = std::sin(1.0 + k);
    a[k] = std::cos(2.0 * k);
  }
  TaskRows rows;
  const auto rows_at = [&](double t) {
    Eigen::VectorXd x = x0;
    model::integrate(model, x, v * t + 0.5 * a * t * t);
    model::kinematics(model, w, x);
    model::velocities(model, w, v + a * t);
    rows.resize(task.rows(), n);
    task.evaluate(model, w, 0.0, rows);
    return rows;
  };
  const double h = 1e-5;
  const TaskRows before = rows_at(-h), after = rows_at(h), now = rows_at(0.0);
  EXPECT_LT((now.jacobian * v - now.velocity).norm(), 1e-12);
  // The goal stands still: the error changes by minus the velocity, the velocity by J a + bias.
  const Eigen::VectorXd velocity = (before.error - after.error) / (2.0 * h);
  EXPECT_LT((velocity - now.velocity).norm(), tolerance) << task.name();
  const Eigen::VectorXd acceleration = (after.velocity - before.velocity) / (2.0 * h);
  EXPECT_LT((acceleration - now.jacobian * a - now.bias).norm(), 1e-6) << task.name();
}

TEST(Tasks, VelocityJacobianAndBiasBelongTogether) {
  const auto model = body();
  model::Workspace w(model);
  model::kinematics(model, w, model::state_from_coordinates(model, testing_body::coordinates(model, 40)));
  const TimeBase still{.rate_hz = 1.0, .t0_s = 0.0, .frames = 1};
  // The error of an orientation is a rotation vector, whose rate is the angular velocity where it vanishes.
  const int forearm = model.body_of(2);
  expect_consistent(
      model,
      *orientation_task("forearm", {Eigen::Quaterniond(w.rotation[static_cast<std::size_t>(forearm)])},
                        still),
      1e-6);
  expect_consistent(model, *coordinate_task("knee", {0.3}, still), 1e-8);
  expect_consistent(
      model, *distance_task({"forearm", {0.0, -0.2, 0.0}}, {"shank", {0.0, -0.1, 0.0}}, {0.5}, still), 1e-8);
  expect_consistent(
      model, *distance_task({"kneecap", {0.01, 0.0, 0.0}}, {"ground", {1.0, 0.0, 0.0}}, {0.5}, still), 1e-8);
}

TEST(Tasks, AMovingOrientationFeedsItsRateForward) {
  const auto model = body();
  const TimeBase time{.rate_hz = 50.0, .t0_s = 0.0, .frames = 100};
  std::vector<Eigen::Quaterniond> goals;
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -1.0).normalized();
  for (int f = 0; f < 100; ++f) {
    const double t = f / 50.0;
    Eigen::Quaterniond goal(Eigen::AngleAxisd(0.5 + 2.0 * t + 0.5 * t * t, axis));
    if (f % 3 == 0) goal.coeffs() = -goal.coeffs();  // the same rotation
    goals.push_back(goal);
  }
  const auto task = orientation_task("trunk", goals, time);
  ASSERT_TRUE(task->bind(model));
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  model::velocities(model, w, Eigen::VectorXd::Zero(model.speed_count()));
  TaskRows rows;
  rows.resize(3, model.speed_count());
  task->evaluate(model, w, 1.005, rows);
  EXPECT_LT((rows.goal_velocity - 3.005 * axis).norm(), 1e-4);
  EXPECT_LT((rows.goal_acceleration - axis).norm(), 1e-2);
  EXPECT_DOUBLE_EQ(rows.weight[0], 0.01);
}

TEST(Tasks, TheyBringTheBodyToTheirGoals) {
  const auto model = body();
  const auto markers = testing_body::record(model, 150);
  const TimeBase still{.rate_hz = 100.0, .t0_s = 0.0, .frames = 1};
  TrackOptions options{.levels = {{.markers = {"T1", "T2", "T3", "T4"}}, {}}, .strict = true, .step_s = 2e-3};
  options.levels[1].tasks = {
      coordinate_task("elbow", {0.4}, still), coordinate_task("arm_rot", {-0.2}, still),
      distance_task({"thigh", {0.0, -0.3, 0.0}}, {"forearm", {0.0, -0.2, 0.0}}, {0.6}, still)};
  const auto result = track_markers(model, markers, options);
  ASSERT_TRUE(result) << result.error().message;
  const auto& motion = result->motion;
  EXPECT_NEAR(motion.q[motion.index(149, motion.find("elbow"))], 0.4, 1e-3);
  EXPECT_NEAR(motion.q[motion.index(149, motion.find("arm_rot"))], -0.2, 1e-3);
  model::Workspace w(model);
  Eigen::VectorXd q(motion.size());
  for (std::int64_t c = 0; c < motion.size(); ++c) q[c] = motion.q[motion.index(149, c)];
  model::kinematics(model, w, model::state_from_coordinates(model, q));
  const Eigen::Vector3d way = model::point_in_world(w, model.body_of(3), {0.0, -0.3, 0.0}) -
                              model::point_in_world(w, model.body_of(2), {0.0, -0.2, 0.0});
  EXPECT_NEAR(way.norm(), 0.6, 2e-3);
  EXPECT_LT(result->rms_goal_error_m, 1e-3);  // the trunk above is not disturbed
}

// A distance along a straight arm does not depend on the elbow; elsewhere it does.
TEST(Tasks, WhatATaskMovesIsLookedForInMoreThanOnePose) {
  const auto model = body();
  auto markers = testing_body::record(model, 60);
  for (std::int64_t f = 0; f < 60; ++f)  // a body that stands still in its rest pose
    for (const char* name : {"U1", "U2", "F1", "F2", "K1"}) markers.set_missing(f, markers.find(name));
  const TimeBase still{.rate_hz = 100.0, .t0_s = 0.0, .frames = 1};
  TrackOptions options{.levels = {{.markers = {"T1", "T2", "T3", "T4", "H1", "H2", "S1", "S2", "S3"}}},
                       .step_s = 2e-3};
  const auto none = track_markers(model, markers, options).value();
  EXPECT_THAT(none.locked_coordinates, ::testing::Contains("elbow"));
  options.levels.push_back({.tasks = {distance_task({"upper_arm", {0.0, -0.01, 0.0}},
                                                    {"forearm", {0.01, -0.2, 0.0}}, {0.35}, still)}});
  const auto track = track_markers(model, markers, options).value();
  EXPECT_THAT(track.locked_coordinates, ::testing::Not(::testing::Contains("elbow")));
  EXPECT_THAT(track.locked_coordinates, ::testing::Contains("arm_flex"));  // no distance in the arm moves it
}

TEST(Tasks, SayWhatIsWrongWithThem) {
  const auto model = body();
  const TimeBase time{.rate_hz = 100.0, .t0_s = 0.0, .frames = 3};
  const auto sentence = [&](const std::shared_ptr<Task>& task) {
    const auto status = task->bind(model);
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(sentence(coordinate_task("wing", {0.0}, time)), HasSubstr("does not have it"));
  EXPECT_THAT(sentence(coordinate_task("tilt", {0.0}, time)), HasSubstr("free root"));
  EXPECT_THAT(sentence(coordinate_task("elbow", {0.0, 1.0}, time)), HasSubstr("2 goals for 3 frames"));
  EXPECT_THAT(sentence(coordinate_task("elbow", {0.0, NAN, 1.0}, time)), HasSubstr("not a number"));
  EXPECT_THAT(sentence(coordinate_task("elbow", {0.0}, time, 0.0)), HasSubstr("more than 0"));
  EXPECT_THAT(sentence(orientation_task("tail", {Eigen::Quaterniond::Identity()}, time)),
              HasSubstr("'tail'"));
  EXPECT_THAT(sentence(orientation_task("ground", {Eigen::Quaterniond::Identity()}, time)),
              HasSubstr("welded"));
  EXPECT_THAT(sentence(orientation_task("trunk", {Eigen::Quaterniond(0, 0, 0, 0)}, time)),
              HasSubstr("unit quaternion"));
  EXPECT_THAT(sentence(distance_task({"trunk", {}}, {"trunk", {}}, {1.0}, time)), HasSubstr("one body"));
  EXPECT_THAT(sentence(distance_task({"trunk", {}}, {"", {}}, {0.0}, time)), HasSubstr("more than 0"));
}

TEST(Tasks, EvaluatingAllocatesNothing) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const auto model = body();
  const TimeBase still{.rate_hz = 100.0, .t0_s = 0.0, .frames = 1};
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  model::velocities(model, w, Eigen::VectorXd::Zero(model.speed_count()));
  for (const auto& task :
       {orientation_task("trunk", {Eigen::Quaterniond::Identity()}, still),
        coordinate_task("elbow", {0.1}, still), distance_task({"trunk", {}}, {"shank", {}}, {0.4}, still)}) {
    ASSERT_TRUE(task->bind(model));
    TaskRows rows;
    rows.resize(task->rows(), model.speed_count());
    const auto before = testing_support::allocations_on_this_thread();
    task->evaluate(model, w, 0.5, rows);
    EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
  }
}

}  // namespace
}  // namespace kinemark::motion
