// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/pivot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

TEST(Pivot, TakesMeanAndQuantilesOff) {
  std::vector<double> deviations;
  for (int k = 1; k <= 39; ++k) deviations.push_back(0.1 * k);  // mean 2; ranks 1 and 39 at 95 %
  const auto found = pivot(10.0, deviations, 0.95);
  EXPECT_NEAR(found.value, 8.0, 1e-12);
  EXPECT_NEAR(found.low, 10.0 - 3.9, 1e-12);
  EXPECT_NEAR(found.high, 10.0 - 0.1, 1e-12);
  EXPECT_NEAR(found.sd, 0.1 * std::sqrt(39.0 * 40.0 / 12.0), 1e-12);
}

TEST(Pivot, CoversAtItsLevelWithFewDeviations) {
  // Exchangeable deviations: 38 of 40 ranks lie within, whatever their distribution.
  Random random(11, 0);
  int covered = 0;
  const int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> deviations(39);
    for (double& d : deviations) d = std::exp(random.gaussian());
    const double estimate = 3.0 + std::exp(random.gaussian());
    const auto found = pivot(estimate, deviations, 0.95);
    covered += found.low <= 3.0 && 3.0 <= found.high;
  }
  EXPECT_NEAR(covered / static_cast<double>(trials), 0.95, 0.012);
}

TEST(Pivot, LeavesOutWhatRefitsDoNotDetermine) {
  std::vector<double> deviations(40, 1.0);
  for (int k = 0; k < 4; ++k) deviations[static_cast<std::size_t>(k)] = kNaN;
  EXPECT_NEAR(pivot(2.0, deviations, 0.95).value, 1.0, 1e-15);
  deviations[4] = kNaN;  // more than a tenth
  EXPECT_TRUE(std::isnan(pivot(2.0, deviations, 0.95).value));
  EXPECT_TRUE(std::isnan(pivot(2.0, {}, 0.95).low));
}

TEST(PivotOfSquare, TakesAConstantOffTheSquares) {
  const std::vector<double> deviations(39, 9.0);
  const auto found = pivot_of_square(5.0, deviations, 0.95);
  EXPECT_NEAR(found.value, 4.0, 1e-12);
  EXPECT_NEAR(found.high, 4.0, 1e-12);
  const std::vector<double> more(39, 30.0);
  EXPECT_EQ(pivot_of_square(5.0, more, 0.95).value, 0.0);
  EXPECT_TRUE(std::isnan(pivot_of_square(5.0, more, 0.95).sd));
}

TEST(WidePivot, HoldsThePivotAndThePercentileInterval) {
  // Lopsided: from -1 to 9.
  std::vector<double> off;
  for (int i = 0; i <= 100; ++i) off.push_back(-1.0 + 0.1 * i);
  const auto basic = pivot(20.0, off, 0.9), wide = wide_pivot(20.0, off, 0.9);
  EXPECT_LT(basic.high, 21.0);
  EXPECT_EQ(wide.low, basic.low);
  EXPECT_NEAR(wide.high, 20.0 + (20.0 - basic.low), 1e-9);  // the percentile's upper end
  EXPECT_EQ(wide.value, basic.value);
  EXPECT_EQ(wide.sd, basic.sd);
}

TEST(WidePivot, OfLevelDeviationsIsThePivot) {
  std::vector<double> off;
  for (int i = -50; i <= 50; ++i) off.push_back(0.1 * i);
  const auto basic = pivot(3.0, off, 0.95), wide = wide_pivot(3.0, off, 0.95);
  EXPECT_NEAR(basic.low, wide.low, 1e-12);
  EXPECT_NEAR(basic.high, wide.high, 1e-12);
  EXPECT_TRUE(std::isnan(wide_pivot(kNaN, {}, 0.95).low));
}

TEST(WidePivotOfSquare, HasRootsForEnds) {
  const std::vector<double> off{1.0, 2.0, 3.0, 4.0, 5.0};
  const auto wide = wide_pivot_of_square(2.0, off, 0.6);
  EXPECT_EQ(wide.low, 0.0);
  EXPECT_GT(wide.high, 2.0);
}

}  // namespace
}  // namespace kinemark::analysis
