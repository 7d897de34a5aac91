// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/orientations.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace kinemark::data {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Orientations two_sensors() {
  const double half = std::sqrt(0.5);
  return {.names = {"pelvis_imu", "tibia_r_imu"},
          .time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 2, .first_number = 1},
          .quaternion = {1.0, 0.0, 0.0, 0.0, half, 0.0, 0.0, half, kMissing, kMissing, kMissing, kMissing,
                         half, half, 0.0, 0.0},
          .warnings = {}};
}

TEST(Orientations, AQuaternionIsWorldFromSensor) {
  const auto sensors = two_sensors();
  ASSERT_TRUE(sensors.validate());
  EXPECT_TRUE(sensors.present(0, 0));
  EXPECT_FALSE(sensors.present(1, 0));
  // A quarter turn about z takes the sensor's x to the world's y.
  EXPECT_TRUE((sensors.rotation(0, 1) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE((sensors.rotation(1, 1) * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST(Orientations, WhatIsNoneIsRefused) {
  auto sensors = two_sensors();
  sensors.quaternion[5] = 0.5;
  EXPECT_THAT(sensors.validate().error().message, ::testing::HasSubstr("sensor 'tibia_r_imu', frame 1"));
  sensors = two_sensors();
  sensors.quaternion[9] = 0.0;
  EXPECT_TRUE(sensors.validate()) << "a part of it is NaN: it is missing";
  sensors = two_sensors();
  sensors.names[1] = "pelvis_imu";
  EXPECT_THAT(sensors.validate().error().message, ::testing::HasSubstr("twice"));
  sensors = two_sensors();
  sensors.names[1].clear();
  EXPECT_FALSE(sensors.validate());
  sensors = two_sensors();
  sensors.time.rate_hz = 0.0;
  EXPECT_FALSE(sensors.validate());
  sensors = two_sensors();
  sensors.quaternion.pop_back();
  EXPECT_FALSE(sensors.validate());
}

}  // namespace
}  // namespace kinemark::data
