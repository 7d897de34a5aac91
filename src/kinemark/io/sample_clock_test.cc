// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/sample_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;

/// Frames `frame` of a rate from 100 s on, each late by up to `jitter_s`.
std::vector<double> times(const std::vector<std::int64_t>& frame, double rate_hz, double jitter_s) {
  Random random(3, 0);
  std::vector<double> out;
  for (const std::int64_t f : frame)
    out.push_back(100.0 + static_cast<double>(f) / rate_hz + random.uniform(0.0, 1.0) * jitter_s);
  return out;
}

std::vector<std::int64_t> all_but(std::int64_t frames, std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> out;
  for (std::int64_t f = 0; f < frames; ++f)
    if (f < first || f > last) out.push_back(f);
  return out;
}

TEST(SampleClock, JitterIsNoGap) {
  const auto frames = all_but(2000, -1, -1);
  for (const double jitter : {0.0, 0.2, 0.6}) {
    const auto clock = find_clock(times(frames, 240.0, jitter / 240.0), 240.0);
    ASSERT_TRUE(clock) << clock.error().message;
    EXPECT_EQ(clock->frame, frames) << jitter;
    EXPECT_EQ(clock->dropped, 0);
    EXPECT_EQ(clock->rate_hz, 240.0);
    EXPECT_NEAR(clock->start_s, 100.0 + 0.5 * jitter / 240.0, 0.05 / 240.0);
  }
}

TEST(SampleClock, GapsAreWholeFramesInJitterToo) {
  for (const double jitter : {0.0, 0.1}) {
    const auto frames = all_but(1000, 300, 309);
    const auto clock = find_clock(times(frames, 120.0, jitter / 120.0), 120.0);
    ASSERT_TRUE(clock) << clock.error().message;
    EXPECT_EQ(clock->frame, frames);
    EXPECT_EQ(clock->dropped, 10);
    EXPECT_NEAR(clock->widest_gap_s, 11.0 / 120.0, jitter / 120.0 + 1e-9);
  }
}

TEST(SampleClock, ASingleDroppedFrameIsSeenWhereThereIsLittleJitter) {
  const auto frames = all_but(100, 40, 40);
  const auto clock = find_clock(times(frames, 100.0, 0.0), 100.0);
  ASSERT_TRUE(clock);
  EXPECT_EQ(clock->frame, frames);
}

TEST(SampleClock, ARateThatTheTimesContradictIsReplaced) {
  const auto frames = all_but(3000, -1, -1);
  const auto other = find_clock(times(frames, 119.88, 0.0), 120.0);
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->rate_hz, 119.88, 1e-6);
  const auto unknown = find_clock(times(frames, 90.0, 0.0), 0.0);
  ASSERT_TRUE(unknown);
  EXPECT_NEAR(unknown->rate_hz, 90.0, 1e-6);
}

TEST(SampleClock, SamplesWithoutTimesFollowTheOneBefore) {
  const auto clock = find_clock({kNaN, 10.0, kNaN, kNaN, 10.03}, 100.0);
  ASSERT_TRUE(clock) << clock.error().message;
  EXPECT_THAT(clock->frame, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_NEAR(clock->start_s, 9.99, 1e-9);
}

TEST(SampleClock, OneSampleNeedsARateThatIsStated) {
  EXPECT_TRUE(find_clock({5.0}, 100.0));
  EXPECT_FALSE(find_clock({5.0}, 0.0));
  EXPECT_FALSE(find_clock({}, 100.0));
  EXPECT_FALSE(find_clock({kNaN}, 100.0));
}

TEST(SampleClock, TimesThatMakeNoSenseAreRefused) {
  EXPECT_FALSE(find_clock({3.0, 2.0, 1.0}, 100.0));
  EXPECT_FALSE(find_clock({0.0, 1e300}, 100.0));
  EXPECT_FALSE(find_clock({0.0, 1e6}, 100.0));  // a hundred million frames dropped
  EXPECT_FALSE(find_clock({1.0, 1.0, 1.0}, 0.0));
}

TEST(SampleClock, OffsetsAreALineThatDriftsWithTheClock) {
  std::vector<double> t = {0.0, 100.0, 200.0};
  correct_clock({}, t);
  EXPECT_THAT(t, ElementsAre(0.0, 100.0, 200.0));
  const std::vector<std::pair<double, double>> one = {{50.0, 7.0}},
                                               two = {{0.0, 1.0}, {100.0, 1.01}, {NAN, 3.0}};
  correct_clock(one, t);
  EXPECT_THAT(t, ElementsAre(7.0, 107.0, 207.0));
  t = {0.0, 100.0, 200.0};
  correct_clock(two, t);
  EXPECT_NEAR(t[0], 1.0, 1e-12);
  EXPECT_NEAR(t[2], 201.02, 1e-9);
}

}  // namespace
}  // namespace kinemark::io
