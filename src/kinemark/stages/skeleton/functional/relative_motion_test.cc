// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/relative_motion.h"

#include <gtest/gtest.h>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

RelativeMotion motion_of(const testing::ChainSetup& setup) {
  const auto chain = testing::make_chain(setup);
  const Samples samples{chain.markers, {}};
  return measure_motion(find_segment_poses(samples, "a", chain.layout.segments[0].markers),
                        find_segment_poses(samples, "b", chain.layout.segments[1].markers));
}

TEST(RelativeMotion, AHingeIsAHingeAndABallABall) {
  using testing::Rotations;
  const auto hinge = motion_of({.rotations = Rotations::hinge, .range_rad = 1.0});
  EXPECT_EQ(hinge.kind(0.0), data::JointKind::hinge);
  EXPECT_NEAR(hinge.range_rad, 1.0, 0.02);
  EXPECT_NEAR(hinge.sd_rad(0), 1.0 / std::sqrt(12.0), 0.02);
  EXPECT_LT(hinge.sd_rad(1), 1e-6);
  const auto cone = motion_of({.rotations = Rotations::cone, .range_rad = 1.0});
  EXPECT_EQ(cone.kind(0.0), data::JointKind::ball);
  EXPECT_GT(cone.range_rad, 0.9);
  EXPECT_EQ(motion_of({.rotations = Rotations::anywhere}).kind(0.0), data::JointKind::ball);
}

TEST(RelativeMotion, NoiseAcrossAHingeDoesNotMakeABallOfIt) {
  const auto motion =
      motion_of({.rotations = testing::Rotations::hinge, .range_rad = 0.5, .noise_sd_m = 0.001});
  EXPECT_EQ(motion.kind(0.03), data::JointKind::hinge);
  EXPECT_EQ(
      motion_of({.rotations = testing::Rotations::hinge, .range_rad = 0.0, .noise_sd_m = 0.001}).kind(0.05),
      data::JointKind::ball)
      << "what does not move is no hinge";
}

TEST(RelativeMotion, OnlyFramesWithBothPosesCount) {
  const auto motion = motion_of({.missing = 0.3});
  EXPECT_GT(motion.frames.size(), 20U);
  EXPECT_LT(motion.frames.size(), 60U);
}

}  // namespace
}  // namespace kinemark::skeleton
