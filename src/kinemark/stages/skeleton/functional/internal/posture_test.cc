// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/posture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::internal {
namespace {

Posture posture_in(const testing::JointSetup& setup) {
  return posture_of(setup.parent, setup.child, setup.task.motion, setup.task.motion.frames,
                    setup.chain.markers.time.rate_hz);
}

TEST(Posture, ComponentsAreAboutTheirMeanLargestFirst) {
  const testing::JointSetup setup(testing::make_swings({}));
  const Posture posture = posture_in(setup);
  EXPECT_EQ(posture.frames.size(), 800U);
  EXPECT_NEAR(posture.step_s, 0.02, 1e-12);
  EXPECT_LT(posture.component.colwise().mean().norm(), 1e-12);
  EXPECT_LT(posture.smooth.colwise().mean().norm(), 1e-12);
  EXPECT_GE(posture.sd_rad(0), posture.sd_rad(1));
  EXPECT_GE(posture.sd_rad(1), posture.sd_rad(2));
}

TEST(Posture, AtMostFiftyFramesASecondAndThreeThousand) {
  auto chain = testing::make_swings({.movements = 40});
  chain.markers.time.rate_hz = 200.0;
  EXPECT_EQ(posture_in(testing::JointSetup(chain)).frames.size(), 1000U);
  chain.markers.time.rate_hz = 10.0;
  const Posture slow = posture_in(testing::JointSetup(chain));
  EXPECT_EQ(slow.frames.size(), 2000U);
  EXPECT_NEAR(slow.step_s, 0.2, 1e-12);
}

// A recorder that makes three of four frames leaves every fourth.
TEST(Posture, FramesThatAreLeftOutTakeTheirTime) {
  auto chain = testing::make_swings({.movements = 40});
  chain.markers.time.rate_hz = 200.0;
  const testing::JointSetup setup(chain);
  std::vector<std::int64_t> measured;
  for (const auto f : setup.task.motion.frames)
    if (f % 4 == 0) measured.push_back(f);
  const Posture posture = posture_of(setup.parent, setup.child, setup.task.motion, measured, 200.0);
  EXPECT_EQ(posture.frames, measured) << "fifty a second are all there are";
  EXPECT_NEAR(posture.step_s, 0.02, 1e-12);
}

TEST(Posture, ComponentsThatHardlyMoveAreDamped) {
  const Posture hinge = posture_in(testing::JointSetup(testing::make_swings({.hinge = true})));
  EXPECT_EQ(hinge.kind[0], TermKind::linear);
  EXPECT_EQ(hinge.kind[1], TermKind::damped);
  EXPECT_LT(hinge.smooth.col(1).norm(), 0.01 * hinge.component.col(1).norm());
  const Posture ball = posture_in(testing::JointSetup(testing::make_swings({})));
  EXPECT_EQ(ball.kind[1], TermKind::linear);
  EXPECT_GT(ball.smooth.col(1).norm(), 0.9 * ball.component.col(1).norm());
}

TEST(Posture, SmoothingTakesNothingFromPosesWithoutAPath) {
  const testing::JointSetup setup(
      testing::make_chain({.frames = 300, .per_segment = 4, .rotations = testing::Rotations::cone}));
  const Posture posture = posture_in(setup);
  EXPECT_FALSE(posture.in_time);
  EXPECT_EQ(posture.block, 1);
  EXPECT_LT((posture.smooth.col(0) - posture.component.col(0)).norm(), 0.1 * posture.component.col(0).norm());
  EXPECT_EQ(posture.terms.rightCols<kLagTerms>().norm(), 0.0);
  for (const int m : movements_of(posture)) EXPECT_EQ(m, 0) << "no movements can be told";
}

TEST(Posture, MovementsAreCounted) {
  for (const bool hinge : {false, true})
    for (const int movements : {3, 8, 12}) {
      const auto found = movements_of(posture_in(testing::JointSetup(
          testing::make_swings({.movements = movements, .hinge = hinge, .noise_sd_m = 0.002}))));
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      const auto count = static_cast<int>(std::set<int>(found.begin(), found.end()).size());
      EXPECT_EQ(count, movements) << hinge;
    }
}

}  // namespace
}  // namespace kinemark::skeleton::internal
