// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/clock_time.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

constexpr double kTen = 36000.0;

TEST(ClockTime, IsReadWithAndWithoutADate) {
  for (const char* text :
       {"2024-05-01T10:00:00.010", "2024-05-01 10:00:00.010", "2024/05/01 10:00:00.010",
        "2024-5-1T10:00:00,010", "2024-05-01T10:00:00.010Z", "2024-05-01T12:00:00.010+02:00",
        "2024-05-01T04:30:00.010-0530", " 2024-05-01T10:00:00.010 "}) {
    const auto time = parse_clock_time(text);
    ASSERT_TRUE(time) << text;
    EXPECT_EQ(time->day, 19844) << text;
    EXPECT_NEAR(time->second, kTen + 0.01, 1e-9) << text;
    EXPECT_NEAR(time->resolution_s, 1e-3, 1e-15) << text;
  }
  const auto bare = parse_clock_time("9:59:59.5").value();
  EXPECT_EQ(bare.day, 0);
  EXPECT_NEAR(bare.second, kTen - 0.5, 1e-9);
  EXPECT_EQ(parse_clock_time("10:00:00").value().resolution_s, 1.0);
  EXPECT_NEAR(parse_clock_time("01:23.456").value().second, 83.456, 1e-9) << "minutes and seconds";
}

TEST(ClockTime, WhatIsNoneIsNone) {
  for (const char* text : {"",
                           "10",
                           "10:00",
                           "1.5",
                           "2024-05-01",
                           "2024-13-01T10:00:00",
                           "2024-02-30T10:00:00",
                           "10:60:00",
                           "10:00:61",
                           "25:00:00",
                           "10:00:00 AM",
                           "10:00:00.01x",
                           "a:b:c",
                           "10:00:00+2",
                           "2024-05-01T01:23.456",
                           "LASI:X",
                           "1:2:3",
                           "99999999999:00:00",
                           "10:00:00.",
                           "::",
                           "2024-05-01T10:00:00.010+02:00 and more"})
    EXPECT_FALSE(parse_clock_time(text)) << text;
}

}  // namespace
}  // namespace kinemark::io
