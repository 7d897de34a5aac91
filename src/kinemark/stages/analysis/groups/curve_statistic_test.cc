// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/curve_statistic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/groups/testing/random_curves.h"

namespace kinemark::analysis {
namespace {

using testing::numbers;

std::vector<double> observed(Design design, const std::vector<data::CycleCurves>& groups) {
  CurveStatistic statistic(design, groups);
  std::vector<double> values(statistic.points());
  auto arrangements = statistic.arrangements(100, 1);
  statistic.of(arrangements.next(), values);
  return values;
}

// Student (1908), sleep gained with two drugs: t = 4.0621 paired, 1.8608 with equal variances.
const std::vector<double> kDrugOne{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kDrugTwo{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(CurveStatistic, StudentsOwnNumbers) {
  EXPECT_NEAR(observed(Design::paired, {numbers(kDrugTwo), numbers(kDrugOne)})[0], 4.0621, 5e-5);
  EXPECT_NEAR(observed(Design::two_sample, {numbers(kDrugTwo), numbers(kDrugOne)})[0], 1.8608, 5e-5);
  EXPECT_NEAR(observed(Design::one_sample, {numbers({1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4})})[1],
              4.0621, 5e-5);
}

TEST(CurveStatistic, FOfTwoGroupsIsTSquared) {
  const double f = observed(Design::one_way, {numbers(kDrugTwo), numbers(kDrugOne)})[0];
  const double t = observed(Design::two_sample, {numbers(kDrugTwo), numbers(kDrugOne)})[0];
  EXPECT_NEAR(f, t * t, 1e-12);
}

TEST(CurveStatistic, FOfThreeGroupsByHand) {
  // Means 2, 3 and 7 about 4: 42 between on 2, 6 within on 6 degrees of freedom.
  const std::vector<data::CycleCurves> groups{numbers({1, 2, 3}), numbers({2, 3, 4}), numbers({6, 7, 8})};
  EXPECT_NEAR(observed(Design::one_way, groups)[0], 21.0, 1e-12);
  const CurveStatistic statistic(Design::one_way, groups);
  EXPECT_EQ(statistic.effect_df(), 2);
  EXPECT_EQ(statistic.error_df(), 6);
}

TEST(CurveStatistic, DegreesOfFreedom) {
  const std::vector<data::CycleCurves> groups{numbers(kDrugTwo), numbers(kDrugOne)};
  EXPECT_EQ(CurveStatistic(Design::paired, groups).error_df(), 9);
  EXPECT_EQ(CurveStatistic(Design::two_sample, groups).error_df(), 18);
}

TEST(CurveStatistic, AnArrangementIsTheSameAsCurvesInThatOrder) {
  const std::vector<data::CycleCurves> groups{numbers({1, 5, 2}), numbers({4, 3})};
  CurveStatistic statistic(Design::two_sample, groups);
  std::vector<double> values(2);
  statistic.of({0, 1, 0, 0, 1}, values);
  EXPECT_NEAR(values[0], observed(Design::two_sample, {numbers({1, 2, 4}), numbers({5, 3})})[0], 1e-12);
  CurveStatistic pairs(Design::one_sample, std::span(groups).first(1));
  pairs.of({0, 1, 1}, values);
  EXPECT_NEAR(values[0], observed(Design::one_sample, {numbers({1, -5, -2})})[0], 1e-12);
}

TEST(CurveStatistic, WithoutVarianceOrWithAMissingCurveAPointIsLeftOut) {
  auto group = numbers({0.1, 0.1, 0.1});
  EXPECT_TRUE(std::isnan(observed(Design::two_sample, {group, group})[0]));
  group.values[1] = kNaN;
  const auto values = observed(Design::two_sample, {group, numbers({1, 2})});
  EXPECT_FALSE(std::isnan(values[0]));
  EXPECT_TRUE(std::isnan(values[1]));
}

TEST(CurveStatistic, OfEqualCurvesWithinGroupsIsLargeAndFinite) {
  const auto values = observed(Design::two_sample, {numbers({1, 1, 1}), numbers({2, 2, 2})});
  EXPECT_TRUE(std::isfinite(values[0]));
  EXPECT_LT(values[0], -1e6);
}

}  // namespace
}  // namespace kinemark::analysis
