// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;

TEST(Tree, HasItsSides) {
  const auto sides = tree_sides_m();
  for (const auto& pose : tree_test_poses()) {
    const auto leds = pose.leds_in_world();
    EXPECT_NEAR((leds.col(0) - leds.col(1)).norm(), sides[0], 1e-15);
    EXPECT_NEAR((leds.col(0) - leds.col(2)).norm(), sides[1], 1e-15);
    EXPECT_NEAR((leds.col(1) - leds.col(2)).norm(), sides[2], 1e-15);
    EXPECT_LT((leds.rowwise().mean() - pose.centroid_in_world).norm(), 1e-15);
  }
  EXPECT_NEAR(sides[0], 0.533, 0.0);
  EXPECT_GT(tree_vertices().col(2).z(), 0.0);  // the front LED is nearest to the cameras
}

TEST(Tree, StandsStill) {
  const auto scene = still_tree(tree_test_poses()[3]);
  EXPECT_EQ(scene.leds.size(), 3U);
  EXPECT_EQ(scene.led(1, 0.0).x_in_world, scene.led(1, 77.0).x_in_world);
  EXPECT_EQ(scene.led(2, 0.0).normal, Vector3d::UnitZ());
}

TEST(Wheel, GoesRoundInItsPlane) {
  const WheelOptions options{.rotation_deg = 35.0};
  const auto scene = rotating_wheel(options);
  const auto pose = wheel_pose(options);
  for (const double t : {0.0, 0.1, 0.37, 2.0}) {
    const Vector3d in_wheel = pose.inverse() * scene.led(0, t).x_in_world;
    EXPECT_NEAR(in_wheel.z(), 0.0, 1e-15);
    EXPECT_NEAR(in_wheel.norm(), 0.196, 1e-15);
    EXPECT_NEAR(scene.led(0, t).normal.dot(pose.rotation.col(2)), 1.0, 1e-15);
  }
  EXPECT_LT((scene.led(0, 2.0 / 3.0).x_in_world - scene.led(0, 0.0).x_in_world).norm(), 1e-15);
  EXPECT_FALSE(scene.reflection);
}

TEST(Wheel, CarriesSeveralLeds) {
  const auto scene = rotating_wheel({.leds = 8});
  ASSERT_EQ(scene.leds.size(), 8U);
  EXPECT_EQ(scene.leds[7], "rim 8");
  EXPECT_NEAR((scene.led(0, 0.2).x_in_world - scene.led(4, 0.2).x_in_world).norm(), 0.392, 1e-15);
  EXPECT_EQ(scene.led(0, 0.2).x_in_world, rotating_wheel().led(0, 0.2).x_in_world);
}

TEST(Wheel, TheGlintLastsEightDegreesOfEachTurn) {
  const auto scene = rotating_wheel({.glint_share = 0.04});
  int on = 0;
  constexpr int kSteps = 36000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps / 1.5;
    const auto mirror = scene.reflection(0, t, Vector3d(1.0, 2.0, 3.0));
    on += mirror.share > 0.0;
    EXPECT_LT((mirror.position_in_world - Vector3d(1.0, 2.26, 3.03)).norm(), 1e-15);
  }
  EXPECT_NEAR(360.0 * on / kSteps, 8.0, 0.02);
  EXPECT_EQ(scene.reflection(0, 1.0 / (2.0 * std::numbers::pi * 1.5), Vector3d::Zero()).share, 0.04);
}

TEST(Sign, BonesKeepTheirLengths) {
  const auto scene = signing_arm();
  ASSERT_EQ(scene.leds.size(), 4U);
  const double lengths[] = {0.310, 0.280, 0.080};
  for (double t = 0.0; t < 4.0; t += 0.0037)
    for (int bone = 0; bone < 3; ++bone)
      EXPECT_NEAR((scene.led(bone, t).x_in_world - scene.led(bone + 1, t).x_in_world).norm(), lengths[bone],
                  1e-14);
}

TEST(Sign, TheHandGoesAtTheSpeedsOfThePaper) {
  // The period and the unevenness solve: fastest 2.7 m/s, slowest 0.5 m/s, without the slow drift along Z.
  const auto scene = signing_arm();
  const auto hand = [&scene](double t) {
    Vector3d x = scene.led(3, t).x_in_world;
    x.z() -= 0.006 * std::sin(2.0 * std::numbers::pi * 0.31 * t);
    return x;
  };
  double fastest = 0.0, slowest = 1e9;
  for (double t = 0.0; t < 0.7189; t += 2e-5) {
    const double speed = (hand(t + 1e-6) - hand(t - 1e-6)).norm() / 2e-6;
    fastest = std::max(fastest, speed);
    slowest = std::min(slowest, speed);
  }
  EXPECT_NEAR(fastest, 2.7, 1e-6);
  EXPECT_NEAR(slowest, 0.5, 1e-6);
}

TEST(Sign, OcclusionsAreThoseOfTheStudy) {
  const auto scene = signing_arm();
  ASSERT_EQ(scene.occlusions.size(), 3U);
  std::int64_t frames = 0;
  for (const auto& o : scene.occlusions) frames += o.last_frame - o.first_frame + 1;
  EXPECT_EQ(frames, 12 + 10 + 7);
}

}  // namespace
}  // namespace kinemark::simulation
