// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"

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
using testing_limbs::true_poses;

// Turns that the noise nearly hides fit it: residuals come out too small, shapes too wide.
TEST(Bootstrap, SeesWhatWeakTurnsDo) {
  const RandomChain weak = make_random_chain({.frames = 150, .stagger_m = 0.004, .noise_sd_m = 0.003});
  const RandomChain firm = make_random_chain({.frames = 150});
  EXPECT_TRUE(has_weak_rotation(weak.chain, 0.003));
  EXPECT_FALSE(has_weak_rotation(firm.chain, 0.001));
  const Bootstrap found = bootstrap(weak.samples, true_poses(weak), known_geometry(weak, 0.003), 1);
  EXPECT_LT(found.chi2_ratio, 0.97);
  EXPECT_GT(found.variance_ratio, 0.9);
  Chain wider = weak.chain;
  wider.move_geometry(found.bias);
  EXPECT_GT(wider.marker.topRows<2>().norm(), weak.chain.marker.topRows<2>().norm());
}

// Rotations that stand far out of the noise are Gaussian: nothing to correct.
TEST(Bootstrap, FindsNoBiasWhereRotationsAreFirm) {
  const RandomChain limb = make_random_chain({.frames = 120});
  const FittedChain fit = known_geometry(limb, 0.001);
  const Bootstrap found = bootstrap(limb.samples, true_poses(limb), fit, 2);
  EXPECT_NEAR(found.chi2_ratio, 1.0, 0.12);
  EXPECT_NEAR(found.variance_ratio, 1.0, 0.3);
  EXPECT_LT(found.bias.cwiseAbs().maxCoeff(), 0.001);
  EXPECT_LT((limb.chain.gauge().transpose() * found.bias).norm(), 1e-12) << "a gauge is no bias";
  EXPECT_EQ(bootstrap(limb.samples, true_poses(limb), fit, 2).bias, found.bias) << "the same seed";
}

TEST(HasWeakRotation, LinesAndPairsOfMarkersHaveNoneToLose) {
  const RandomChain line = make_random_chain({.frames = 1, .kind = data::SegmentKind::line});
  EXPECT_FALSE(has_weak_rotation(line.chain, 0.05));
  const RandomChain pair = make_random_chain({.markers_per_segment = 2, .frames = 1});
  EXPECT_FALSE(has_weak_rotation(pair.chain, 0.05));
}

TEST(Bootstrap, WithoutFramesThereIsNothingToCorrect) {
  const RandomChain limb = make_random_chain({.frames = 5});
  const Bootstrap found = bootstrap(limb.samples, {}, known_geometry(limb, 0.001), 1);
  EXPECT_EQ(found.chi2_ratio, 1.0);
  EXPECT_EQ(found.variance_ratio, 1.0);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
