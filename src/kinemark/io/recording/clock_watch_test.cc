// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/clock_watch.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

constexpr std::uint64_t kMs = 1'000'000;

TEST(StepsBetween, CountsOverTheEndOfTheCounter) {
  EXPECT_EQ(steps_between(5, 6), 1);
  EXPECT_EQ(steps_between(6, 5), -1);
  EXPECT_EQ(steps_between(5, 5), 0);
  EXPECT_EQ(steps_between(0xFFFFFFFFU, 0), 1);
  EXPECT_EQ(steps_between(1, 0xFFFFFFFFU), -2);
}

TEST(ClockWatch, EvenAndJitteringMessagesAreNoJump) {
  ClockWatch watch(100.0);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const std::uint64_t jitter = i % 2 == 0 ? 0 : 2 * kMs;
    EXPECT_FALSE(watch.observe(i, 10 * kMs * i + jitter)) << i;
  }
}

TEST(ClockWatch, ALossIsNoJumpWhenTheClockWentOnWithIt) {
  ClockWatch watch(100.0);
  EXPECT_FALSE(watch.observe(0, 0));
  EXPECT_FALSE(watch.observe(50, 500 * kMs));
}

TEST(ClockWatch, TellsHowFarTheClockRanBackOrLeapt) {
  ClockWatch watch(100.0);
  watch.observe(0, 5000 * kMs);
  const auto back = watch.observe(1, 4000 * kMs);
  ASSERT_TRUE(back);
  EXPECT_NEAR(*back, -1.01, 1e-9);
  EXPECT_FALSE(watch.observe(2, 4010 * kMs));  // reported once
  const auto leap = watch.observe(3, 4520 * kMs);
  ASSERT_TRUE(leap);
  EXPECT_NEAR(*leap, 0.5, 1e-9);
}

TEST(ClockWatch, WithoutARateOnlyRunningBackwardsIsSeen) {
  ClockWatch watch(0.0);
  watch.observe(0, 100 * kMs);
  EXPECT_FALSE(watch.observe(1, 90'000 * kMs));
  const auto back = watch.observe(2, 89'000 * kMs);
  ASSERT_TRUE(back);
  EXPECT_NEAR(*back, -1.0, 1e-9);
}

TEST(ClockWatch, TheWholeRangeOfClocksIsTaken) {
  ClockWatch watch(100.0);
  watch.observe(0, 0);
  EXPECT_NEAR(watch.observe(1, ~0ULL).value(), 1.8446744e10, 1e4);
  EXPECT_NEAR(watch.observe(2, 0).value(), -1.8446744e10, 1e4);
}

}  // namespace
}  // namespace kinemark::io
