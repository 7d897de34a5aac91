// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/still_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
namespace ts = testing_support;

/// Three LEDs that jump to another position every ten frames.
data::Counts recording(const data::Rig& rig) {
  const auto tree = test_tree();
  return ts::count_paths(
      rig, 3, 50, 100.0,
      [&](int led, double t) {
        return Vector3d(tree[static_cast<std::size_t>(led)] +
                        Vector3d(0.05 * std::floor(t / 0.1 + 1e-6), 0, 0));
      },
      4);
}

TEST(StillPoses, AveragesRunsOfFrames) {
  const auto rig = ts::ideal_rig();
  const auto poses = still_poses(recording(rig), rig, test_tree(), 10);
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses(), 5);
  double z2 = 0.0;
  for (int pose = 0; pose < 5; ++pose)
    for (int led = 0; led < 3; ++led)
      for (int c = 0; c < 2; ++c) {
        const auto& s = poses->at(pose, led, c);
        ASSERT_TRUE(s.seen());
        const Vector3d position = test_tree()[static_cast<std::size_t>(led)] + Vector3d(0.05 * pose, 0, 0);
        z2 += (s.counts - ts::mean_counts(rig.cameras[static_cast<std::size_t>(c)], position)).squaredNorm() /
              s.variance / 120.0;
      }
  EXPECT_NEAR(z2, 1.0, 0.35);
}

TEST(StillPoses, LeavesOutWhatMovedOrWasNotSeen) {
  const auto rig = ts::ideal_rig();
  auto counts = recording(rig);
  counts.flags[counts.index(13, 0, 0)] |= data::kCountSaturated;
  for (std::int64_t f = 20; f < 30; ++f)
    counts.counts[4 * counts.index(f, 1, 1)] =
        static_cast<std::int16_t>(counts.counts[4 * counts.index(f, 1, 1)] + 6 * (f - 20));
  const auto poses = still_poses(counts, rig, test_tree(), 10).value();
  EXPECT_FALSE(poses.at(1, 0, 0).seen());
  EXPECT_TRUE(poses.at(1, 0, 1).seen());
  EXPECT_FALSE(poses.at(2, 1, 1).seen());
  EXPECT_FALSE(still_poses(counts, rig, test_tree(), 25).value().at(0, 2, 0).seen());  // two places and a
                                                                                       // half in one run
}

TEST(StillPoses, FlickerCountsAsFarAsItDoesNotAverageOut) {
  const auto rig = ts::ideal_rig();
  const auto counts = recording(rig);
  // 120 Hz at 100 frames per second: ten frames hold two periods, seven do not.
  const double ten = still_observation(counts, rig.electronics, {0, 10}, 0, 0).variance;
  const double seven = still_observation(counts, rig.electronics, {0, 7}, 0, 0).variance;
  const double noise = ts::count_sd(rig) * ts::count_sd(rig);
  EXPECT_NEAR(ten, noise / 10.0, 0.01 * ten);
  EXPECT_GT(seven, 1.02 * noise / 7.0);
}

TEST(StillPoses, TreeFromItsSides) {
  const auto tree = test_tree();
  EXPECT_NEAR((tree[0] - tree[1]).norm(), 0.533, 1e-12);
  EXPECT_NEAR((tree[0] - tree[2]).norm(), 0.310, 1e-12);
  EXPECT_NEAR((tree[1] - tree[2]).norm(), 0.310, 1e-12);
  EXPECT_GT(tree[2].z(), 0.0);
  EXPECT_THAT(tree_from_sides({1.0, 0.3, 0.3}).error().message, HasSubstr("close no triangle"));
  EXPECT_THAT(tree_from_sides({1.0}).error().message, HasSubstr("three were expected"));
}

TEST(StillPoses, LeavesAPoseOutThatWasCutOff) {
  const auto rig = ts::ideal_rig();
  const auto counts = recording(rig);
  const auto whole = still_poses(counts, rig, test_tree(), 10),
             cut = still_poses(counts, rig, test_tree(), 7);
  ASSERT_TRUE(whole && cut);
  EXPECT_EQ(whole->poses(), 5);
  EXPECT_EQ(whole->frames_left_over, 0);
  EXPECT_EQ(cut->poses(), 7);
  EXPECT_EQ(cut->frames_left_over, 1);
}

TEST(StillPoses, RefusesWhatDoesNotFit) {
  const auto rig = ts::ideal_rig();
  auto counts = recording(rig);
  EXPECT_THAT(still_poses(counts, rig, {Vector3d::Zero()}, 10).error().message,
              HasSubstr("3 LEDs and the tree 1"));
  EXPECT_THAT(still_poses(counts, rig, test_tree(), 60).error().message,
              HasSubstr("50 frames hold no whole pose of 60 frames"));
  auto one = rig;
  one.cameras.pop_back();
  EXPECT_THAT(still_poses(counts, one, test_tree(), 10).error().message,
              HasSubstr("2 cameras and the rig 1"));
  counts.rig_id = "x";
  one = rig;
  one.id = "y";
  EXPECT_THAT(still_poses(counts, one, test_tree(), 10).error().message,
              HasSubstr("rig 'x', this rig is 'y'"));
}

}  // namespace
}  // namespace kinemark::calibration
