// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/distortion.h"

#include <gtest/gtest.h>

#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

constexpr data::Distortion kLens{.k1 = -0.2, .k2 = 0.3, .k3 = -0.1, .p1 = 5e-4, .p2 = -3e-4};

TEST(Distort, NoneLeavesSlopesAlone) {
  const Eigen::Vector2d slopes(0.13, -0.2);
  EXPECT_EQ(distort({}, slopes).slopes, slopes);
  EXPECT_EQ(undistort({}, slopes).value(), slopes);
}

TEST(Distort, RadialAndTangentialTermsByHand) {
  // At (0.1, 0.2) r^2 is 0.05; every term alone.
  const Eigen::Vector2d at(0.1, 0.2);
  EXPECT_NEAR(distort({.k1 = 1}, at).slopes.x(), 0.1 * 1.05, 1e-16);
  EXPECT_NEAR(distort({.k2 = 1}, at).slopes.y(), 0.2 * 1.0025, 1e-16);
  EXPECT_NEAR(distort({.k3 = 1}, at).slopes.y(), 0.2 * 1.000125, 1e-16);
  EXPECT_NEAR(distort({.p1 = 1}, at).slopes.x(), 0.1 + 2 * 0.02, 1e-16);
  EXPECT_NEAR(distort({.p1 = 1}, at).slopes.y(), 0.2 + 0.05 + 0.08, 1e-16);
  EXPECT_NEAR(distort({.p2 = 1}, at).slopes.x(), 0.1 + 0.05 + 0.02, 1e-16);
  EXPECT_NEAR(distort({.p2 = 1}, at).slopes.y(), 0.2 + 2 * 0.02, 1e-16);
}

TEST(Distort, DerivativesMatchDifferences) {
  Random random(3, 1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d at{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
    const auto by_slopes =
        differences([](const Eigen::VectorXd& x) { return distort(kLens, x).slopes; }, at, 1e-3);
    EXPECT_LT((distort(kLens, at).d_slopes - by_slopes).norm(), 1e-11);
    const auto by_lens = differences(
        [&at](const Eigen::VectorXd& k) {
          return distort({.k1 = k[0], .k2 = k[1], .k3 = k[2], .p1 = k[3], .p2 = k[4]}, at).slopes;
        },
        Eigen::VectorXd::Zero(5), 1e-3);
    EXPECT_LT((distort(kLens, at).d_parameters - by_lens).norm(), 1e-11);
  }
}

TEST(Undistort, IsTheInverse) {
  Random random(3, 2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d at{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
    const auto back = undistort(kLens, distort(kLens, at).slopes);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - at).norm(), 1e-13);
  }
}

TEST(Undistort, SaysSoWhereNoRayArrives) {
  // x (1 - x^2) never exceeds 0.385: nothing of this lens arrives at 0.5.
  EXPECT_FALSE(undistort({.k1 = -1.0}, {0.5, 0.0}));
  EXPECT_FALSE(undistort(kLens, {std::nan(""), 0.0}));
}

}  // namespace
}  // namespace kinemark::camera
