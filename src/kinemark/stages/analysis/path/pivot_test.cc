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

TEST(PivotOfSquare, KeepsTheUpperEndAboveZero) {
  // Squares below what the noise adds: 1, with 30 to 68 taken off. Their mean stays 0, the end keeps its
  // distance.
  std::vector<double> deviations;
  for (int k = 0; k < 39; ++k) deviations.push_back(30.0 + k);
  const auto found = pivot_of_square(1.0, deviations, 0.95);
  EXPECT_EQ(found.value, 0.0);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_NEAR(found.high, std::sqrt(49.0 - 30.0), 1e-12);
  // A square above 0 has the pivot's own end.
  const auto above = pivot_of_square(8.0, deviations, 0.95);
  EXPECT_NEAR(above.value, std::sqrt(64.0 - 49.0), 1e-12);
  EXPECT_NEAR(above.high, std::sqrt(64.0 - 30.0), 1e-12);
}

TEST(PivotOfSquare, HoldsASpreadThatTheNoiseHides) {
  // Twelve values of spread 0.3 to 1 in noise of 1 per value that refits overstate by a half.
  Random random(7, 0);
  int covered = 0, none = 0;
  const int trials = 300;
  const auto variance = [](const std::vector<double>& x) {
    double mean = 0.0, squares = 0.0;
    for (const double v : x) mean += v / static_cast<double>(x.size());
    for (const double v : x) squares += (v - mean) * (v - mean);
    return squares / static_cast<double>(x.size() - 1);
  };
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> truth(12), seen(12), again(12), deviations(99);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      truth[i] = (0.3 + 0.1 * (trial % 8)) * random.gaussian();
      seen[i] = truth[i] + random.gaussian();
    }
    for (double& d : deviations) {
      for (std::size_t i = 0; i < seen.size(); ++i) again[i] = seen[i] + 1.5 * random.gaussian();
      d = variance(again) - variance(seen);
    }
    const auto found = pivot_of_square(std::sqrt(variance(seen)), deviations, 0.95);
    const double sd = std::sqrt(variance(truth));
    covered += found.low <= sd && sd <= found.high;
    none += found.high <= 0.0;
  }
  EXPECT_GE(covered, 85 * trials / 100);
  EXPECT_EQ(none, 0);
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
