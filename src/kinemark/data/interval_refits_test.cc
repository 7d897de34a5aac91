// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/interval_refits.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::data {
namespace {

TEST(IntervalRefits, AreAsManyAsTheLevelNeeds) {
  EXPECT_EQ(least_refits(0.95), 39);
  EXPECT_EQ(least_refits(0.98), 99);
  EXPECT_EQ(least_refits(0.99), 199);
  EXPECT_EQ(least_refits(0.995), 399);
  EXPECT_EQ(least_refits(0.999), 1999);
  EXPECT_EQ(least_refits(0.9999), 19999);
  EXPECT_EQ(least_refits(0.8), 39) << "never fewer";
  for (double level = 0.96; level < 0.9999; level += 0.00037) {
    const auto least = static_cast<double>(least_refits(level));
    EXPECT_GE((least + 1.0) * 0.5 * (1.0 - level), 1.0 - 1e-6) << level;
    EXPECT_LT(least * 0.5 * (1.0 - level), 1.0) << level;
  }
  for (const double none : {0.5, 1.0, 1.5, std::nan("")}) EXPECT_EQ(least_refits(none), 0) << none;
}

TEST(IntervalRefits, AreCheckedWithTheirLevel) {
  EXPECT_TRUE(check_interval_refits(0, 0.999));
  EXPECT_TRUE(check_interval_refits(39, 0.95));
  EXPECT_TRUE(check_interval_refits(99, 0.98));
  EXPECT_EQ(check_interval_refits(38, 0.95).error().message,
            "38 refits; need 0 (no intervals) or at least 39 for intervals of level 0.95");
  EXPECT_EQ(check_interval_refits(99, 0.99).error().message,
            "99 refits; need 0 (no intervals) or at least 199 for intervals of level 0.99");
  EXPECT_EQ(check_interval_refits(99, 0.99).error().code, Code::usage);
  for (const double none : {0.5, 1.0, 0.99995, std::nan("")}) {
    EXPECT_FALSE(check_interval_refits(0, none)) << none;
  }
  EXPECT_EQ(check_interval_refits(99, 1.0).error().message,
            "intervals of level 1; need one above 0.5 and at most 0.9999");
}

}  // namespace
}  // namespace kinemark::data
