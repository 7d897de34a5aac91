// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/usable.h"

#include <gmock/gmock.h>

namespace kinemark::camera {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/// One LED before one camera; `light` is the sum of the four counts of each frame.
data::Counts seen(const std::vector<int>& light) {
  data::Counts out;
  out.leds = {"led"};
  out.cameras = {"A"};
  out.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = static_cast<std::int64_t>(light.size())};
  out.conversion_time_s.assign(4, 0.0);
  for (const int sum : light) {
    for (const int part : {sum - 3 * (sum / 4), sum / 4, sum / 4, sum / 4})
      out.counts.push_back(static_cast<std::int16_t>(part));
    out.flags.push_back(0);
  }
  return out;
}

TEST(UsableViews, MoreThanAShareOfTheMedianIsEnoughLight) {
  auto counts = seen({1000, 1000, 1000, 200, 201, 199, 1000, 1000});
  ASSERT_TRUE(counts.validate());
  EXPECT_THAT(usable_views(counts, 0.2), ElementsAre(1, 1, 1, 0, 1, 0, 1, 1)) << "at the bound is too little";
  EXPECT_THAT(usable_views(counts, 0.0), Each(1));
}

TEST(UsableViews, OffsetsAndStrayLightAreNoSighting) {
  EXPECT_THAT(usable_views(seen({60, 61, 12}), 0.5), ElementsAre(0, 1, 0));
}

TEST(UsableViews, FlaggedSightingsAreLeftOutHoweverBright) {
  for (const auto flag : {data::kCountSaturated, data::kCountOccluded, data::kCountLost}) {
    auto counts = seen({900, 900, 900});
    counts.flags[1] = flag;
    EXPECT_THAT(usable_views(counts, 0.5), ElementsAre(1, 0, 1)) << int{flag};
  }
}

// What is hidden says nothing of how bright the LED is; what is saturated says that it is bright.
TEST(UsableViews, TheMedianIsOfTheLightThatCame) {
  auto counts = seen({1000, 1000, 4000, 4000, 4000});
  EXPECT_THAT(usable_views(counts, 0.5), ElementsAre(0, 0, 1, 1, 1));
  for (const std::size_t f : {2, 3, 4}) counts.flags[f] = data::kCountSaturated;
  EXPECT_THAT(usable_views(counts, 0.5), ElementsAre(0, 0, 0, 0, 0));
  for (const std::size_t f : {2, 3, 4}) counts.flags[f] = data::kCountOccluded;
  EXPECT_THAT(usable_views(counts, 0.5), ElementsAre(1, 1, 0, 0, 0));
}

TEST(UsableViews, EachLedAndCameraHasAMedianOfItsOwn) {
  auto counts = seen({1000, 100, 1000, 100, 1000, 100});
  counts.leds = {"bright", "far"};
  counts.time.frames = 3;
  counts.conversion_time_s.assign(8, 0.0);
  ASSERT_TRUE(counts.validate());
  EXPECT_THAT(usable_views(counts, 0.5), Each(1));
}

TEST(UsableViews, NothingSeenAndNoFrames) {
  auto dark = seen({0, 0});
  EXPECT_THAT(usable_views(dark, 0.5), ElementsAre(0, 0));
  dark.flags = {data::kCountLost, data::kCountLost};
  EXPECT_THAT(usable_views(dark, 0.5), ElementsAre(0, 0));
  EXPECT_TRUE(usable_views(seen({}), 0.5).empty());
}

}  // namespace
}  // namespace kinemark::camera
