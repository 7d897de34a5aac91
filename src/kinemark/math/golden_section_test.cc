// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/golden_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kinemark::math {
namespace {

TEST(GoldenSection, EnclosesTheMinimumAndShrinksByTheGoldenRatio) {
  for (const double truth : {-1.9, -0.3, 0.0, 1.234, 1.999}) {
    int calls = 0;
    const auto found = golden_section(
        [&](double x) {
          ++calls;
          return std::cosh(x - truth);
        },
        -2.0, 2.0, {.sections = 20});
    EXPECT_LE(found.low, truth);
    EXPECT_GE(found.high, truth);
    EXPECT_NEAR(found.high - found.low, 4.0 * std::pow(std::numbers::phi, -20), 1e-12);
    EXPECT_EQ(calls, 22);
    EXPECT_NEAR(found.middle(), truth, found.high - found.low);
  }
}

TEST(GoldenSection, TellsTheSmallestValueThatItSaw) {
  std::vector<double> positions;
  const auto f = [](double x) { return std::abs(x - 0.4) + 0.3 * std::sin(20.0 * x); };  // several minima
  const auto found = golden_section(
      [&](double x) {
        positions.push_back(x);
        return f(x);
      },
      0.0, 1.0, {.width = 1e-3});
  EXPECT_LE(found.high - found.low, 1e-3);
  EXPECT_EQ(found.value, f(found.at));
  for (const double x : positions) EXPECT_GE(f(x), found.value);
}

TEST(GoldenSection, GoesToTheEndOfAFunctionWithoutMinimum) {
  const auto falls = golden_section([](double x) { return -x; }, 0.0, 1.0, {.width = 1e-6});
  EXPECT_EQ(falls.high, 1.0);
  const auto rises = golden_section([](double x) { return x; }, 0.0, 1.0, {.width = 1e-6});
  EXPECT_EQ(rises.low, 0.0);
}

TEST(GoldenSection, StopsAtWhicheverComesFirst) {
  int calls = 0;
  const auto f = [&](double x) {
    ++calls;
    return x * x;
  };
  (void)golden_section(f, -1.0, 1.0, {.width = 10.0, .sections = 5});
  EXPECT_EQ(calls, 2);
  (void)golden_section(f, -1.0, 1.0, {.width = 1e-9, .sections = 5});
  EXPECT_EQ(calls, 2 + 7);
}

}  // namespace
}  // namespace kinemark::math
