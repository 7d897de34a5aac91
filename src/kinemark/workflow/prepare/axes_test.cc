// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/axes.h"

#include <gmock/gmock.h>

#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One body with y up.
model::Model thing(const Vector3d& gravity = {0.0, -9.81, 0.0}) {
  data::ModelDescription m;
  m.name = "thing";
  m.gravity = gravity;
  m.bodies.push_back({.name = "body", .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity()});
  m.joints.push_back({.name = "root", .child_body_idx = 0});
  m.markers.push_back({.name = "A", .body_idx = 0});
  return model::Model::compile(m).value();
}

/// A marker 1 m above a plate on the floor of a laboratory with z up.
data::Trial z_up() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 10.0, .frames = 1});
  trial.markers.x(0, 0) = Vector3d(0.0, 0.0, 1.0);
  trial.markers.state[0] = data::SampleState::measured;
  trial.force_plates.emplace_back().corners_in_world = {Vector3d(0.3, 0.3, 0.0), Vector3d(-0.3, 0.3, 0.0),
                                                        Vector3d(-0.3, -0.3, 0.0), Vector3d(0.3, -0.3, 0.0)};
  return trial;
}

data::Wrenches pushes_along(const Vector3d& force) {
  return {.time = {.rate_hz = 10.0, .frames = 1},
          .items = {{.name = "p",
                     .body = "",
                     .force = {force.x(), force.y(), force.z()},
                     .moment = {0.0, 0.0, 0.0},
                     .point = {0.0, 0.0, 0.0}}}};
}

TEST(AxesChoice, RefusesWhatItDoesNotUnderstand) {
  EXPECT_TRUE(AxesChoice{}.check());
  EXPECT_TRUE((AxesChoice{.up = "auto", .rotate = ""}.check()));
  EXPECT_THAT((AxesChoice{.up = "w", .rotate = ""}.check().error().message),
              HasSubstr("--up: 'w' is not x, y, z"));
  EXPECT_THAT((AxesChoice{.up = "", .rotate = "90"}.check().error().message), HasSubstr("--rotate: '90'"));
  EXPECT_EQ((AxesChoice{.up = "z", .rotate = "x 90"}.check().error().code), Code::usage);
}

TEST(SettleAxes, ADisagreementIsAnErrorThatNamesTheOption) {
  const auto refused = settle_axes({}, "walk.c3d", z_up(), thing());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(
      refused.error().message,
      HasSubstr("walk.c3d: z is up in the recording by the force plates, and y in the model; give --up z"));
}

TEST(SettleAxes, WhatAgreesOrTellsNothingIsTakenAsItIs) {
  EXPECT_TRUE(settle_axes({}, "walk.c3d", z_up(), thing({0.0, 0.0, -9.81}))
                  .value()
                  .model_from_recording.isIdentity(0.0));
  data::Trial bare = z_up();
  bare.force_plates.clear();
  const auto axes = settle_axes({}, "walk.trc", bare, thing()).value();
  EXPECT_TRUE(axes.model_from_recording.isIdentity(0.0));
  EXPECT_FALSE(axes.chosen);
  EXPECT_THAT(settle_axes({.up = "auto", .rotate = ""}, "walk.trc", bare, thing()).error().message,
              HasSubstr("tell which way is up; give --up x, y, z"));
}

TEST(SettleAxes, WhatIsChosenIsDone) {
  for (const AxesChoice& choice :
       {AxesChoice{.up = "z", .rotate = ""}, AxesChoice{.up = "auto", .rotate = ""},
        AxesChoice{.up = "", .rotate = "x -90"}}) {
    data::Trial trial = z_up();
    const auto axes = bring_into_axes(choice, "walk.c3d", trial, thing()).value();
    EXPECT_TRUE(axes.chosen);
    EXPECT_EQ(Vector3d(trial.markers.x(0, 0)), Vector3d::UnitY());
    ASSERT_EQ(trial.warnings.size(), 1U);
    EXPECT_THAT(trial.warnings[0], HasSubstr("the recording was turned: "));
  }
  data::Trial trial = z_up();
  (void)bring_into_axes({.up = "y", .rotate = ""}, "walk.c3d", trial, thing()).value();
  EXPECT_EQ(Vector3d(trial.markers.x(0, 0)), Vector3d::UnitZ()) << "insisted on";
  EXPECT_THAT(trial.warnings, IsEmpty());
}

TEST(SettleAxes, WithoutGravityThereIsNoVertical) {
  EXPECT_TRUE(settle_axes({}, "walk.c3d", z_up(), thing(Vector3d::Zero())));
  EXPECT_THAT(
      settle_axes({.up = "z", .rotate = ""}, "walk.c3d", z_up(), thing(Vector3d::Zero())).error().message,
      HasSubstr("the model has no gravity"));
}

TEST(CheckForces, ThatPushAcrossTheModelAreAnErrorUnlessChosen) {
  const auto model = thing();
  EXPECT_EQ(check_forces(pushes_along({100.0, 700.0, 0.0}), {}, model).value(), "");
  EXPECT_EQ(check_forces(pushes_along({0.0, 0.0, 5.0}), {}, model).value(), "") << "too small to say";
  const auto refused = check_forces(pushes_along({0.0, 0.0, 700.0}), {}, model);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("push along z on average, 90 deg off y"));
  EXPECT_THAT(refused.error().message, HasSubstr("give --up z"));
  Axes chosen;
  chosen.chosen = true;
  EXPECT_THAT(check_forces(pushes_along({0.0, 0.0, 700.0}), chosen, model).value(),
              HasSubstr("90 deg off y"));
}

}  // namespace
}  // namespace kinemark::workflow
