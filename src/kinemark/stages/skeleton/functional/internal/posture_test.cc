// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/posture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"

namespace kinemark::skeleton::internal {
namespace {

/// A first component that swings so many times.
Posture swings(int times, double noise = 0.0) {
  Posture out;
  out.component = Eigen::MatrixX3d::Zero(600, 3);
  for (Eigen::Index i = 0; i < 600; ++i)
    out.component(i, 0) = -std::cos(2.0 * std::numbers::pi * times * static_cast<double>(i) / 600.0) +
                          noise * (i % 2 == 0 ? 1.0 : -1.0);
  out.sd_rad(0) = std::sqrt(out.component.col(0).squaredNorm() / 600.0);
  return out;
}

TEST(Posture, CyclesAreSwingsAndNotNoise) {
  for (const int times : {3, 5, 9}) {
    EXPECT_EQ(count_cycles(swings(times)), times);
    EXPECT_EQ(count_cycles(swings(times, 0.3)), times) << "noise below half an SD is no swing";
  }
}

TEST(Posture, CyclesAreThreeToTwelve) {
  EXPECT_EQ(count_cycles(swings(1)), 3);
  EXPECT_EQ(count_cycles(swings(40)), 12);
}

TEST(Posture, ComponentsAreAboutTheirMeanLargestFirst) {
  const testing::JointSetup setup(testing::make_chain(
      {.frames = 2000, .per_segment = 4, .rotations = testing::Rotations::cone, .range_rad = 1.0}));
  const Posture posture = posture_of(setup.parent, setup.child, setup.task.motion);
  EXPECT_EQ(posture.frames.size(), 1500U);
  EXPECT_LT(posture.component.colwise().mean().norm(), 1e-12);
  EXPECT_GE(posture.sd_rad(0), posture.sd_rad(1));
  EXPECT_GE(posture.sd_rad(1), posture.sd_rad(2));
}

}  // namespace
}  // namespace kinemark::skeleton::internal
