// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

Result<Plan> plan_of(const model::Model& model, const TrackOptions& options) {
  return make_plan(model, testing_body::record(model, 4), options);  // 100 Hz
}

TEST(Plan, OmegaTimesStepMayBeHalfAndNoMore) {
  const auto model = body();
  const auto half = plan_of(model, {.omega_rad_s = 50.0, .step_s = 0.01});
  ASSERT_TRUE(half) << half.error().message;
  EXPECT_EQ(half->steps_per_frame, 1);
  EXPECT_DOUBLE_EQ(half->kp, 2500.0);
  EXPECT_DOUBLE_EQ(half->kd, 100.0);
  const auto more = plan_of(model, {.omega_rad_s = 50.1, .step_s = 0.01});
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, Code::usage);
  EXPECT_THAT(more.error().message, HasSubstr("omega x step <= 0.5"));
  // Stiff with little damping is as unstable as stiff: kp step <= kd.
  EXPECT_TRUE(plan_of(model, {.kp = 1000.0, .kd = 10.0, .step_s = 0.01}));
  EXPECT_FALSE(plan_of(model, {.kp = 1010.0, .kd = 10.0, .step_s = 0.01}));
}

TEST(Plan, APrescribedCoordinateIsHeldAtTheRestPoseAndSaid) {
  auto described = testing_body::description();
  described.coordinates[9].prescribed = math::ScalarFunction::sine(0.3, 4.0, 0.2, 0.1);
  const auto model = model::Model::compile(described).value();
  const auto plan = plan_of(model, {}).value();
  const int speed = plan.problem.speed_of(9);
  EXPECT_TRUE(plan.problem.fixed_speed[static_cast<std::size_t>(speed)]);
  EXPECT_TRUE(plan.problem.prescribed.empty());
  EXPECT_THAT(plan.problem.fit.warnings, Contains(HasSubstr("'elbow' is prescribed by a function of time")));
  for (const char* absent : {"is prescribed by a function of time; tracking holds it at the rest pose"})
    EXPECT_THAT(plan_of(body(), {}).value().problem.fit.warnings, Not(Contains(HasSubstr(absent))));
}

TEST(Plan, WithoutAStepItTakesTheLongestThatFitsIntoAFrame) {
  const auto model = body();
  for (const double omega : {10.0, 50.0, 51.0, 100.0, 333.0}) {
    const auto plan = plan_of(model, {.omega_rad_s = omega}).value();
    EXPECT_LE(omega * plan.step_s, 0.5 * (1.0 + 1e-9)) << omega;
    EXPECT_NEAR(plan.step_s * plan.steps_per_frame, 0.01, 1e-15);
    if (plan.steps_per_frame > 1) {
      EXPECT_GT(omega * 0.01 / (plan.steps_per_frame - 1), 0.5) << omega;
    }
  }
}

TEST(Plan, TheRestPoseIsWithinTheLimits) {
  const auto model = body();
  const auto plan =
      plan_of(model,
              {.rest_pose = {{.coordinate = "elbow", .value = 9.0}, {.coordinate = "knee", .value = -0.25}}})
          .value();
  const auto coordinates = plan.problem.model.coordinates();
  EXPECT_EQ(plan.rest[coordinates[9].state_idx], 2.5);
  EXPECT_EQ(plan.rest[coordinates[11].state_idx], -0.25);
  EXPECT_THAT(plan_of(model, {.rest_pose = {{.coordinate = "knee", .value = std::nan("")}}}).error().message,
              HasSubstr("'knee' is not a number"));
}

TEST(Plan, PosesAroundStayWithinLimitsAndLeaveTheLockedAlone) {
  const auto model = body();
  const auto plan = plan_of(model, {.locked = {"hip"}}).value();
  Eigen::VectorXd x = plan.rest;
  const auto coordinates = plan.problem.model.coordinates();
  x[coordinates[9].state_idx] = 2.4;  // 0.1 rad below its limit
  const auto poses = poses_around(plan, x);
  ASSERT_EQ(poses.size(), 20U);
  double lowest = 9.0, highest = -9.0;
  for (const auto& pose : poses) {
    EXPECT_EQ(pose[coordinates[10].state_idx], x[coordinates[10].state_idx]);
    lowest = std::min(lowest, pose[coordinates[9].state_idx]);
    highest = std::max(highest, pose[coordinates[9].state_idx]);
    for (const auto& free : plan.problem.model.free_joints())
      EXPECT_EQ(pose.segment<7>(free.state_idx), x.segment<7>(free.state_idx));
  }
  EXPECT_LE(highest, 2.5);
  EXPECT_GE(lowest, 1.9);
  EXPECT_LT(lowest, 2.2);
  EXPECT_EQ(poses, poses_around(plan, x)) << "the same every time";
}

TEST(Plan, LocksAMarkerlessJointAndKeepsTheOthers) {
  auto description = testing_body::description();
  std::erase_if(description.markers, [](const auto& m) { return m.name[0] == 'F'; });
  const auto model = model::Model::compile(std::move(description)).value();
  auto plan = plan_of(model, {}).value();
  lock_idle(plan, {.followed = {plan.rest}});
  EXPECT_EQ(plan.locked, std::vector<int>{9});
  Eigen::VectorXd x = plan.rest;
  x[plan.problem.model.coordinates()[9].state_idx] = 0.7;
  plan.apply_locks(x);
  EXPECT_EQ(x, plan.rest);
}

TEST(BodyByName, KnowsTheGroundByBothNamesAndRefusesStrangers) {
  const auto model = body();
  EXPECT_EQ(body_by_name(model, "").value(), data::kGround);
  EXPECT_EQ(body_by_name(model, "ground").value(), data::kGround);
  EXPECT_EQ(body_by_name(model, "shank").value(), model.body_of(4));
  EXPECT_EQ(body_by_name(model, "tail").error().message, "the model has no body 'tail'");
  EXPECT_TRUE(is_welded(model, data::kGround));
  EXPECT_FALSE(is_welded(model, model.body_of(4)));
}

}  // namespace
}  // namespace kinemark::motion::internal
