// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/level_guard.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinemark::motion::internal {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Shows errors (mm) of two levels with bounds of 10 and 20 mm for so many frames at 100 Hz.
void show(LevelGuard& guard, double first_mm, double second_mm, int frames = 1) {
  for (int i = 0; i < frames; ++i) guard.look(Eigen::Vector2d(1e-3 * first_mm, 1e-3 * second_mm));
}

LevelGuard guard(bool given_up = false) { return {{0.01, 0.02}, 100.0, given_up}; }

TEST(LevelGuard, ActsAfter50MillisecondsBeyondABoundAndNotBefore) {
  auto g = guard();
  show(g, 9.0, 19.0, 1000);
  EXPECT_FALSE(g.joined());
  show(g, 9.0, 21.0, 4);
  EXPECT_FALSE(g.joined());
  show(g, 9.0, 19.0);  // back in between: counted anew
  show(g, 11.0, 1.0, 4);
  EXPECT_FALSE(g.joined());
  show(g, 11.0, 1.0);
  EXPECT_TRUE(g.joined());
  EXPECT_EQ(g.trips(), 1);
}

TEST(LevelGuard, LetsGoAfterASecondWithinBoundsAndLaterEachTime) {
  auto g = guard();
  show(g, 50.0, 1.0, 5);
  show(g, 1.0, 1.0, 99);
  EXPECT_TRUE(g.joined());
  show(g, 1.0, 1.0);
  EXPECT_FALSE(g.joined());
  show(g, 50.0, 1.0, 5);
  show(g, 1.0, 1.0, 199);
  EXPECT_TRUE(g.joined()) << "twice as long";
  show(g, 50.0, 1.0, 100);
  EXPECT_TRUE(g.joined()) << "never while a level is beyond";
  show(g, 1.0, 1.0);
  EXPECT_FALSE(g.joined());
  EXPECT_FALSE(g.given_up());
}

TEST(LevelGuard, TheThirdTimeIsToTheEnd) {
  auto g = guard();
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(g.joined()) << i;
    show(g, 50.0, 1.0, 5);
    show(g, 1.0, 1.0, 400);
  }
  EXPECT_TRUE(g.joined());
  EXPECT_TRUE(g.given_up());
  show(g, 1.0, 1.0, 10000);
  EXPECT_TRUE(g.joined());
  EXPECT_EQ(g.trips(), 3);
}

TEST(LevelGuard, ALevelWithoutGoalsIsNotBeyondAndOneSumIsNotAskedToLetGo) {
  auto g = guard();
  show(g, kNothing, 1.0, 100);
  EXPECT_FALSE(g.joined());
  auto from_the_start = guard(true);
  show(from_the_start, 1.0, 1.0, 1000);
  EXPECT_TRUE(from_the_start.joined());
  EXPECT_EQ(from_the_start.trips(), 0);
}

TEST(LevelGuard, OneSumHasReachedWhatItCanAfterAFifthOfASecond) {
  auto g = guard();
  EXPECT_FALSE(g.settled());
  show(g, 50.0, 1.0, 5);
  show(g, 50.0, 1.0, 19);
  EXPECT_FALSE(g.settled());
  show(g, 50.0, 1.0);
  EXPECT_TRUE(g.settled());
  EXPECT_TRUE(g.is_beyond(0, 0.011));
  EXPECT_FALSE(g.is_beyond(1, 0.011));
}

TEST(LevelGuard, WithoutBoundsItNeverActs) {
  LevelGuard none({}, 100.0, false);
  none.look(Eigen::Vector2d(1.0, 1.0));
  EXPECT_FALSE(none.joined());
  EXPECT_FALSE(none.is_beyond(0, 1.0));
}

}  // namespace
}  // namespace kinemark::motion::internal
