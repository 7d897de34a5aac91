// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/motion_coordinates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

using math::ScalarFunction;

/// One CustomJoint that coordinate 0 moves by the given axes.
ModelDescription joint_of(std::vector<AxisDescription> axes) {
  ModelDescription m;
  m.bodies = {{.name = "patella", .mass = 0.1}};
  m.coordinates = {{.name = "beta"}, {.name = "other"}};
  m.joints = {{.name = "j", .type = "CustomJoint", .child_body_idx = 0, .axes = std::move(axes)}};
  return m;
}

AxisDescription by(ScalarFunction f, int coordinate = 0) {
  return {.coordinate_idx = coordinate, .function = std::move(f)};
}

ScalarFunction curve() { return ScalarFunction::simm_spline({0.0, 1.0, 2.0}, {0.0, 0.8, 1.2}).value(); }

TEST(MotionCoordinates, ACoordinateThatMovesByFunctionsAloneKeepsRadians) {
  EXPECT_TRUE(keeps_radians(joint_of({by(curve()), by(ScalarFunction::linear(2.0, 0.0))}), 0));
  EXPECT_TRUE(keeps_radians(joint_of({by(ScalarFunction::linear(-0.5, 0.1))}), 0));
}

TEST(MotionCoordinates, OneAxisThatFollowsItIsEnoughForDegrees) {
  for (const double slope : {1.0, -1.0})
    EXPECT_FALSE(
        keeps_radians(joint_of({by(curve()), by(ScalarFunction::linear(slope, 0.2)), by(curve())}), 0))
        << slope;
  EXPECT_FALSE(keeps_radians(joint_of({by(ScalarFunction{})}), 0));
}

TEST(MotionCoordinates, AMultipliedLineIsNoLine) {
  EXPECT_TRUE(keeps_radians(joint_of({by(ScalarFunction::linear(1.0, 0.0).scaled(1.1))}), 0));
  EXPECT_TRUE(keeps_radians(joint_of({by(ScalarFunction::linear(0.5, 0.0).scaled(2.0))}), 0))
      << "the factor makes it the coordinate itself, but OpenSim looks at the kind of function";
}

TEST(MotionCoordinates, OtherJointsAndOtherCoordinatesAreOrdinary) {
  auto model = joint_of({by(curve())});
  EXPECT_FALSE(keeps_radians(model, 1)) << "it moves nothing";
  model.joints[0].type = "PinJoint";
  EXPECT_FALSE(keeps_radians(model, 0));
  auto product = by(ScalarFunction{}, 1);
  product.second_coordinate_idx = 0;
  EXPECT_TRUE(keeps_radians(joint_of({product}), 0)) << "a factor beside another coordinate";
}

TEST(MotionCoordinates, AMotionTakesAllCoordinatesInTheModelsOrder) {
  auto model = joint_of({by(curve()), by(ScalarFunction{}, 1)});
  model.coordinates[1].is_rotation = false;
  JointMotion motion;
  motion.coordinates = {"of another model"};
  motion.is_rotation = {true};
  set_coordinates(model, motion);
  EXPECT_THAT(motion.coordinates, testing::ElementsAre("beta", "other"));
  EXPECT_THAT(motion.is_rotation, testing::ElementsAre(true, false));
  EXPECT_THAT(motion.keeps_radians, testing::ElementsAre(true, false));
}

}  // namespace
}  // namespace kinemark::data
