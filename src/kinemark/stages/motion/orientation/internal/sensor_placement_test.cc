// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_placement.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using ::testing::HasSubstr;

data::Orientations standing(std::int64_t frames) {
  data::Orientations out{.names = {"Trunk_IMU", "shank"},
                         .time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = frames},
                         .quaternion = {},
                         .warnings = {}};
  for (std::int64_t f = 0; f < 2 * frames; ++f)
    out.quaternion.insert(out.quaternion.end(), {1.0, 0.0, 0.0, 0.0});
  return out;
}

TEST(SensorPlacement, NamesOfBodiesWithAndWithoutImu) {
  const auto model = model::Model::compile(testing_body::description()).value();
  const auto posed = pose_sensors(model, standing(3), nullptr, {}).value();
  ASSERT_EQ(posed.sensors.size(), 2U);
  EXPECT_EQ(model.description().bodies[static_cast<std::size_t>(posed.sensors[0].body_idx)].name, "trunk");
  EXPECT_EQ(model.description().bodies[static_cast<std::size_t>(posed.sensors[1].body_idx)].name, "shank");
  EXPECT_EQ(posed.pose_frames, 1);
  // The default pose of the trunk has no turn.
  EXPECT_TRUE(body_from_sensor(posed, posed.sensors[0], 0.0).isIdentity(1e-12));
}

TEST(SensorPlacement, TakesTheFirstFrameThatHasAllSensors) {
  const auto model = model::Model::compile(testing_body::description()).value();
  auto recording = standing(2);
  for (std::size_t k = 0; k < 4; ++k) recording.quaternion[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(pose_sensors(model, recording, nullptr, {}));
  for (std::size_t k = 8; k < 12; ++k) recording.quaternion[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(pose_sensors(model, recording, nullptr, {}).error().message,
              HasSubstr("no frame has the orientations of all"));
  const auto pose = standing(5);
  EXPECT_EQ(pose_sensors(model, recording, &pose, {}).value().pose_frames, 5);
  auto other = standing(5);
  other.names[1] = "thigh";
  EXPECT_THAT(pose_sensors(model, standing(2), &other, {}).error().message,
              HasSubstr("sensor 'shank' is missing in the pose"));
}

TEST(SensorPlacement, KnowsWhetherThePoseWasHeld) {
  const auto model = model::Model::compile(testing_body::description()).value();
  EXPECT_NEAR(pose_sensors(model, standing(40), nullptr, {}).value().drift_rad, 0.0, 1e-7);
  auto walking = standing(40);
  for (std::size_t f = 0; f < 40; ++f) {
    const double half = 0.5 * 0.02 * static_cast<double>(f);  // 1.2 rad/s at 60 Hz
    walking.quaternion[8 * f] = std::cos(half);
    walking.quaternion[8 * f + 3] = std::sin(half);
  }
  // Of the first half second the halves are 15 frames apart.
  EXPECT_NEAR(pose_sensors(model, walking, nullptr, {}).value().drift_rad, 0.3, 1e-6);
  EXPECT_NEAR(pose_sensors(model, standing(2), &walking, {}).value().drift_rad, 0.4, 1e-6);
}

TEST(SensorPlacement, AnAxisThatFacesGivesTheHeading) {
  const auto model = model::Model::compile(testing_body::description()).value();
  const auto recording = standing(1);
  const auto posed = pose_sensors(model, recording, nullptr, {}).value();
  // About y, upwards: z turned by 90 deg is x.
  EXPECT_NEAR(heading_of(posed, recording, {"shank", Eigen::Vector3d::UnitZ()}).value(), 1.5707963, 1e-6);
  EXPECT_NEAR(heading_of(posed, recording, {"shank", Eigen::Vector3d::UnitX()}).value(), 0.0, 1e-12);
  EXPECT_FALSE(heading_of(posed, recording, {"shank", Eigen::Vector3d::UnitY()}));
}

}  // namespace
}  // namespace kinemark::motion::internal
