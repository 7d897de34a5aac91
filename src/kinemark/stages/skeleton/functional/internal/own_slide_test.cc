// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/own_slide.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kinemark/stages/skeleton/functional/internal/cluster.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::internal {
namespace {

OwnSlide slide_of(const testing::SwingSetup& swings) {
  const testing::JointSetup setup(testing::make_swings(swings));
  const auto pair = find_clusters(setup.samples, setup.parent, setup.child, setup.task.motion);
  const auto posture = posture_of(setup.parent, setup.child, setup.task.motion, pair.frames, 50.0);
  return find_own_slide(deformation(setup.samples, setup.child, pair.child, posture.frames), posture,
                        pair.child.freedom());
}

TEST(OwnSlide, HasItsSize) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const OwnSlide found = slide_of({.own_slide_m = 0.008, .seed = seed});
    EXPECT_EQ(found.weight[0], 0.0) << seed;
    EXPECT_GE(found.limit_m, found.size_m) << seed;
    sum += found.size_m / 10.0;
  }
  EXPECT_NEAR(sum, 0.008, 0.002);
}

TEST(OwnSlide, RigidMarkersHaveNone) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const OwnSlide found = slide_of({.noise_sd_m = 0.001, .seed = seed});
    EXPECT_GT(found.weight[0], 0.5) << seed;
    EXPECT_LT(found.size_m, 0.5e-3) << seed;
    EXPECT_NEAR(std::sqrt(found.noise_variance), 0.001, 0.0002) << seed;
  }
}

TEST(OwnSlide, WhatMovesTheClusterAsOneBodyDoesNotShow) {
  EXPECT_LT(slide_of({.common_slide_m = 0.02}).size_m, 0.5e-3);
}

TEST(OwnSlide, ProbabilitiesAddUpToOne) {
  for (const double slide_m : {0.0, 0.001, 0.02}) {
    const auto found = slide_of({.own_slide_m = slide_m});
    EXPECT_NEAR(std::accumulate(found.weight.begin(), found.weight.end(), 0.0), 1.0, 1e-12);
  }
  EXPECT_EQ(slide_sizes()[0], 0.0);
  EXPECT_NEAR(slide_sizes().back(), 0.08, 1e-12);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
