// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/belt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using testing::KnownWalk;

TEST(BeltPace, ChangesWhereItDoesSlowlyAndNotByChance) {
  Random random(5, 1);
  BeltPace even, ramp;
  for (int i = 0; i < 12; ++i) {
    for (auto* pace : {&even, &ramp}) pace->frame.push_back(50.0 * i);
    const double noise = 0.02 * random.gaussian();
    even.m_per_s.push_back(1.2 + noise);
    ramp.m_per_s.push_back(1.2 + noise + 0.05 * i);
  }
  EXPECT_FALSE(even.changes());
  EXPECT_TRUE(ramp.changes());
  EXPECT_NEAR(ramp.scatter(), 0.02, 0.01);
  EXPECT_NEAR(ramp.scatter(), even.scatter(), 1e-9);
  ramp.frame.resize(5), ramp.m_per_s.resize(5);
  EXPECT_FALSE(ramp.changes());
}

TEST(BeltPace, ItsWayIsTheIntegralOfItsSpeed) {
  const BeltPace pace{.frame = {10.0, 60.0, 110.0}, .m_per_s = {1.0, 2.0, 1.0}, .along = {0.6, -0.8}};
  const auto way = pace.ahead_of(1.0, 121, 100.0);
  EXPECT_NEAR(way.row(10).norm(), 0.0, 1e-12);
  EXPECT_NEAR(way.row(60).norm(), 0.25, 1e-9);
  EXPECT_NEAR(way.row(110).norm(), 0.5, 1e-9);
  EXPECT_NEAR((way.row(120) - way.row(110)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(way(60, 0), 0.15, 1e-9);
  EXPECT_NEAR(way(60, 1), -0.2, 1e-9);
}

// A belt whose speed swings about the walker's, who stays where the belt carries him: strides are as long.
TEST(BeltPace, LengthsAreThoseOnABeltOfChangingSpeed) {
  for (const double swing_m_per_s : {0.0, 0.3}) {
    KnownWalk walk;
    walk.treadmill = true, walk.duration_s = 13.0;
    auto markers = walk.markers(0.0003, 7);
    for (std::int64_t f = 0; f < markers.frames(); ++f) {
      const double phase = 2.0 * std::numbers::pi * markers.time.time_s(f) / 13.0;
      const double ahead = swing_m_per_s * 13.0 / (2.0 * std::numbers::pi) * (1.0 - std::cos(phase));
      for (std::int64_t m = 0; m < markers.markers(); ++m) {
        markers.x(f, m)[0] -= ahead * std::cos(walk.heading_rad);
        markers.x(f, m)[1] -= ahead * std::sin(walk.heading_rad);
      }
    }
    const auto gait = analyze_gait(markers, {}, {.measures = {"stride_length", "gait_speed"}}).value();
    EXPECT_THAT(gait.kind.sentence(), HasSubstr(swing_m_per_s > 0.0 ? "; the feet slide back at 1.0"
                                                                    : "; the feet slide back at 1.3"));
    EXPECT_EQ(std::isfinite(gait.kind.belt_least_m_per_s), swing_m_per_s > 0.0);
    if (swing_m_per_s > 0.0) {
      EXPECT_NEAR(gait.kind.belt_least_m_per_s, 1.0, 0.03);
      EXPECT_NEAR(gait.kind.belt_most_m_per_s, 1.6, 0.03);
    }
    for (const auto& measure : gait.measures) {
      const double truth = measure.id == "gait_speed" ? walk.speed_m_per_s : walk.stride_m();
      EXPECT_NEAR(measure.value, truth, 0.008) << measure.id << " " << swing_m_per_s;
      EXPECT_LT(measure.interval.low, truth + 0.001) << measure.id << " " << swing_m_per_s;
      EXPECT_GT(measure.interval.high, truth - 0.001) << measure.id << " " << swing_m_per_s;
    }
  }
}

}  // namespace
}  // namespace kinemark::analysis
