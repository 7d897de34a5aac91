// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/label_check.h"

#include <gtest/gtest.h>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

namespace kinemark::trajectory::internal {
namespace {

void swap(data::Trajectories& t, Index a, Index b, Index first, Index end) {
  for (Index f = first; f < end; ++f) {
    const Eigen::Vector3d x = t.x(f, a);
    t.x(f, a) = t.x(f, b);
    t.x(f, b) = x;
  }
}

TEST(CheckLabels, FindsSwapsWithinAndBetweenBodiesAndUndoesThem) {
  const data::Trajectories truth = testing::moving_bodies({.noise_m = 3e-4});
  for (const Index other : {3, 8}) {
    data::Trajectories t = truth;
    swap(t, 1, other, 300, 340);
    Recording r(t);
    const auto swaps = check_labels(r);
    ASSERT_EQ(swaps.size(), 1U);
    EXPECT_EQ(swaps[0].first_marker, 1);
    EXPECT_EQ(swaps[0].second_marker, other);
    EXPECT_EQ(swaps[0].first, 300);
    EXPECT_EQ(swaps[0].end, 340);
    for (Index f = 0; f < 600; ++f) EXPECT_EQ(r.x(1, f), truth.x(f, 1)) << f;
  }
}

TEST(CheckLabels, FindsASwapThatBeganAndEndedUnseenByItsDistances) {
  data::Trajectories t = testing::moving_bodies({.noise_m = 3e-4});
  swap(t, 1, 3, 300, 340);
  for (const Index m : {1, 3}) {
    testing::hide(t, m, 297, 301);
    testing::hide(t, m, 338, 342);
  }
  EXPECT_TRUE(find_crossings(Recording(t)).empty());
  Recording r(t);
  const auto swaps = check_labels(r);
  ASSERT_EQ(swaps.size(), 1U);
  EXPECT_EQ(swaps[0].first, 302);
  EXPECT_EQ(swaps[0].end, 338);
  EXPECT_NEAR(swaps[0].distance_m, (t.x(310, 1) - t.x(310, 3)).norm(), 2e-3);
}

TEST(CheckLabels, IsSilentOnCleanMotionAndOnNoise) {
  for (const double noise : {0.0, 3e-4, 3e-3}) {
    Recording r(testing::moving_bodies({.bodies = 3, .noise_m = noise}));
    EXPECT_TRUE(check_labels(r).empty()) << noise;
    for (Index m = 0; m < r.markers(); ++m) EXPECT_LT(r.doubtful(m, 0, 600), 6) << noise;
  }
}

TEST(CheckLabels, DoubtsAMarkerThatIsInNobodysPosition) {
  data::Trajectories t = testing::moving_bodies({.noise_m = 3e-4});
  for (Index f = 100; f < 150; ++f) t.x(f, 2) += Eigen::Vector3d(0.1, 0.05, -0.1);
  Recording r(t);
  EXPECT_TRUE(check_labels(r).empty());
  EXPECT_EQ(r.doubtful(2, 100, 150), 50);
  EXPECT_EQ(r.doubtful(2, 0, 100), 0);
  EXPECT_EQ(r.doubtful(1, 0, 600), 0);
}

TEST(CheckLabels, SaysNothingAboutTooFewMarkers) {
  data::Trajectories t = data::Trajectories::all_missing({"a", "b", "c"}, {.rate_hz = 100.0, .frames = 20});
  Recording r(t);
  EXPECT_TRUE(check_labels(r).empty());
}

TEST(RecordingTest, EstimatesTheNoiseOfASample) {
  const Recording r(testing::moving_bodies({.frames = 2000, .noise_m = 5e-4}));
  for (Index m = 0; m < r.markers(); ++m) EXPECT_NEAR(r.estimate_noise(m), 5e-4, 1e-4);
  EXPECT_EQ(Recording(testing::moving_bodies({.frames = 4})).estimate_noise(0), 0.0);
}

}  // namespace
}  // namespace kinemark::trajectory::internal
