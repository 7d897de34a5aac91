// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

TEST(ThinOut, DrawsEvenlyAndOnlyFramesThatShowTwoMarkers) {
  RandomChain limb = make_random_chain({.frames = 100});
  for (int f = 0; f < 50; ++f)
    for (int k = 0; k < 5; ++k) hide(limb.samples, f, k);
  std::vector<std::int64_t> kept;
  const ChainSamples all = thin_out(limb.samples, 1000, kept);
  EXPECT_EQ(all.frames, 50);
  EXPECT_EQ(kept.front(), 50);
  const ChainSamples some = thin_out(limb.samples, 10, kept);
  ASSERT_EQ(kept.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(kept[i], 50 + 5 * static_cast<std::int64_t>(i));
    EXPECT_EQ(some.frame(static_cast<std::int64_t>(i))[0], limb.samples.frame(kept[i])[0]);
  }
}

TEST(FirstFrames, PrefersWholeFramesAndMakesDoWithFewer) {
  RandomChain limb = make_random_chain({.frames = 100});
  for (int f = 0; f < 40; ++f) hide(limb.samples, f, 1);
  EXPECT_EQ(first_frames(limb.samples, limb.chain).size(), 60U) << "whole frames, if forty or more";
  for (int f = 40; f < 80; ++f) hide(limb.samples, f, 4);
  EXPECT_EQ(first_frames(limb.samples, limb.chain).size(), 100U) << "three of one and two of the other";
}

TEST(ThinOut, NothingIsLeftWhereNoFrameShowsTwoMarkers) {
  RandomChain limb = make_random_chain({.frames = 4});
  for (int f = 0; f < 4; ++f)
    for (int k = 0; k < 5; ++k) hide(limb.samples, f, k);
  std::vector<std::int64_t> kept{7};
  EXPECT_EQ(thin_out(limb.samples, 10, kept).frames, 0);
  EXPECT_TRUE(kept.empty());
}

TEST(FirstFrames, TwoLinesNeedTwoMarkersOfOneOfThem) {
  RandomChain limb = make_random_chain({.frames = 3, .kind = data::SegmentKind::line});
  for (const int k : {1, 2, 4, 5}) hide(limb.samples, 0, k);  // one marker each
  for (const int k : {2, 3, 4, 5}) hide(limb.samples, 1, k);  // two of one, none of the other
  EXPECT_EQ(first_frames(limb.samples, limb.chain), (std::vector<std::int64_t>{1, 2}));
}

TEST(FirstPoses, PredictExactDataExactly) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 10, .noise_sd_m = 0.0});
  const PosedFrames found =
      first_poses(limb.samples, limb.chain, {1, 4, 9}, std::vector<double>(9, 1.0), 0.001, 40);
  EXPECT_EQ(found.frame, (std::vector<std::int64_t>{1, 4, 9}));
  for (std::size_t i = 0; i < found.size(); ++i)
    for (int k = 0; k < 9; ++k) {
      const Eigen::Map<const Vector3d> x(limb.samples.frame(found.frame[i]) + 3 * k);
      EXPECT_LT((limb.chain.predict(found.pose[i], k) - x).norm(), 1e-6) << i << ' ' << k;
    }
}

TEST(FirstPoses, FramesThatShowNothingAreLeftOut) {
  RandomChain limb = make_random_chain({.frames = 3});
  for (int k = 0; k < 6; ++k) hide(limb.samples, 1, k);
  const std::vector<double> all(6, 1.0), none(6, 0.0);
  EXPECT_EQ(first_poses(limb.samples, limb.chain, {0, 1, 2}, all, 0.001, 15).frame,
            (std::vector<std::int64_t>{0, 2}));
  EXPECT_EQ(first_poses(limb.samples, limb.chain, {0, 1, 2}, none, 0.001, 15).size(), 0U);
}

TEST(FirstPoses, AreThoseOfAllStartsForAnyNumberOfThreads) {
  const RandomChain limb = make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 150});
  const std::vector<double> all(12, 1.0);
  std::vector<std::int64_t> frames;
  for (std::int64_t f = 0; f < 150; ++f) frames.push_back(f);
  const PosedFrames one = first_poses(limb.samples, limb.chain, frames, all, 0.001, 40, 1),
                    four = first_poses(limb.samples, limb.chain, frames, all, 0.001, 40, 4);
  ASSERT_EQ(one.frame, frames);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one.pose[i].joint0, four.pose[i].joint0);
    const PosedFrames alone = first_poses(limb.samples, limb.chain, {frames[i]}, all, 0.001, 40);
    EXPECT_LT((one.pose[i].joint0 - alone.pose[0].joint0).norm(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
