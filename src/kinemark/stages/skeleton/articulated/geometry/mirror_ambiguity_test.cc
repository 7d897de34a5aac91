// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/mirror_ambiguity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/true_poses.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;
using testing_limbs::redraw;
using testing_limbs::true_poses;

// Poses that turn about all axes leave one geometry: no mirrored one is tried.
TEST(TryMirrored, NothingIsTriedWhereTheJointTurnsFreely) {
  const RandomChain limb = make_random_chain({.frames = 80});
  FittedChain fit = known_geometry(limb, 0.001);
  EXPECT_FALSE(try_mirrored(limb.samples, true_poses(limb), fit));
  EXPECT_TRUE(std::isinf(fit.mirror_margin));
}

// Too few frames to be sure of the joint: the mirrored geometries are tried, and fit much worse.
TEST(TryMirrored, KeepsTheTrueGeometryAndSaysHowMuchBetterItIs) {
  const RandomChain limb = make_random_chain({.frames = 30});
  FittedChain fit = known_geometry(limb, 0.001);
  EXPECT_FALSE(try_mirrored(limb.samples, true_poses(limb), fit));
  EXPECT_EQ(fit.chain.marker, limb.chain.marker);
  EXPECT_GT(fit.mirror_margin, 100.0);
}

// The joint stays where it is in both segments: either side of the markers' plane explains the frames.
TEST(TryMirrored, AJointThatHardlyMovesIsAmbiguous) {
  RandomChain limb = make_random_chain({.frames = 60});
  for (ChainPose& pose : limb.pose) pose.rotation[1] = pose.rotation[0];
  redraw(limb, 0.001, 3);
  FittedChain fit = known_geometry(limb, 0.001);
  (void)try_mirrored(limb.samples, true_poses(limb), fit);
  EXPECT_LT(fit.mirror_margin, 10.0);
}

TEST(TryMirrored, LinesHaveNoSides) {
  const RandomChain limb = make_random_chain({.frames = 30, .kind = data::SegmentKind::line});
  FittedChain fit = known_geometry(limb, 0.001);
  EXPECT_FALSE(try_mirrored(limb.samples, true_poses(limb), fit));
  EXPECT_TRUE(std::isinf(fit.mirror_margin));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
