// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/mean_band.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/groups/testing/random_curves.h"

namespace kinemark::analysis {
namespace {

using testing::numbers;
using testing::random_curves;

TEST(MeanBand, OfOneValueIsStudentsInterval) {
  // Two equal points are one number: t of 9 degrees of freedom, 97.5 %: 2.262157.
  const auto band = mean_band(numbers({1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4}));
  ASSERT_TRUE(band);
  EXPECT_NEAR(band->mean[0], 1.58, 1e-12);
  EXPECT_NEAR(band->sd[0], 1.229995, 5e-7);
  EXPECT_NEAR(band->factor, 2.262157, 1e-6);
  EXPECT_NEAR(band->of_mean(0), 2.262157 * 1.229995 / std::sqrt(10.0), 1e-6);
  EXPECT_NEAR(band->of_one(0), 2.262157 * 1.229995 * std::sqrt(1.1), 2e-6);
}

// Share of simulated groups whose bands hold at all points.
struct Covered {
  double mean = 0.0, one = 0.0;
};
Covered covered(std::int64_t count, double width, int trials) {
  Covered share;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(31, static_cast<std::uint64_t>(trial));
    const auto band = mean_band(random_curves(random, count, width)).value();
    const auto further = random_curves(random, 1, width);
    bool mean = true, one = true;
    for (std::size_t p = 0; p < 101; ++p) {
      mean = mean && std::abs(band.mean[p]) <= band.of_mean(p);
      one = one && std::abs(further.values[p] - band.mean[p]) <= band.of_one(p);
    }
    share.mean += mean ? 1.0 / trials : 0.0;
    share.one += one ? 1.0 / trials : 0.0;
  }
  return share;
}

TEST(MeanBand, HoldsOverTheWholeCurve) {
  // 600 groups: one standard error of 95 % is 0.9 %.
  for (const auto& [count, width] : {std::pair{6, 8.0}, {12, 8.0}, {25, 20.0}}) {
    const auto share = covered(count, width, 600);
    EXPECT_NEAR(share.mean, 0.95, 0.03) << count << " curves of width " << width;
    EXPECT_NEAR(share.one, 0.95, 0.03) << count << " curves of width " << width;
  }
}

TEST(MeanBand, OfRoughCurvesIsNoWiderThanBonferronis) {
  Random random(32, 0);
  const auto rough = mean_band(random_curves(random, 20, 0.05));
  EXPECT_NEAR(rough->factor, 4.2, 0.1);  // t of 19 degrees of freedom, 0.05 / 202
  Random again(32, 0);
  EXPECT_LT(mean_band(random_curves(again, 20, 30.0))->factor, 3.2);
}

TEST(MeanBand, ASurerBandIsWider) {
  Random random(33, 0);
  const auto curves = random_curves(random, 10, 10.0);
  EXPECT_LT(mean_band(curves, 0.9)->factor, mean_band(curves, 0.99)->factor);
}

TEST(MeanBand, PointsWithAMissingCurveAreLeftOut) {
  Random random(34, 0);
  auto curves = random_curves(random, 6, 10.0);
  curves.values[101 + 7] = kNaN;
  const auto band = mean_band(curves);
  EXPECT_EQ(band->not_tested, 1);
  EXPECT_TRUE(std::isnan(band->mean[7]));
  EXPECT_TRUE(std::isnan(band->of_mean(7)));
  EXPECT_TRUE(std::isfinite(band->of_mean(8)));
}

TEST(MeanBand, NeedsThreeCurvesAndALevel) {
  EXPECT_EQ(mean_band(numbers({1, 2})).error().message, "a band of 2 curves is asked for; need at least 3");
  EXPECT_EQ(mean_band(numbers({1, 2, 3}), 95.0).error().message,
            "the level of a band is 95; need one above 0 and below 1");
}

}  // namespace
}  // namespace kinemark::analysis
