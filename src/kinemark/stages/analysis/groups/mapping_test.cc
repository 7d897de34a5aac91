// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/mapping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/groups/testing/random_curves.h"

namespace kinemark::analysis {
namespace {

using testing::numbers;
using testing::random_curves;

/// Adds `height` to all curves between two points, with soft ends.
void add_bump(data::CycleCurves& curves, double first, double last, double height) {
  for (std::size_t i = 0; i < curves.values.size(); ++i) {
    const auto p = static_cast<double>(i % static_cast<std::size_t>(curves.points));
    curves.values[i] += height / ((1.0 + std::exp(first - p)) * (1.0 + std::exp(p - last)));
  }
}

TEST(MapCurves, FindsADifferenceWhereItIs) {
  Random random(11, 0);
  std::vector<data::CycleCurves> groups{random_curves(random, 12, 8.0), random_curves(random, 12, 8.0)};
  add_bump(groups[0], 40, 60, 4.0);
  const auto mapping = map_curves(groups, {.design = Design::two_sample, .arrangements = 2000});
  ASSERT_TRUE(mapping);
  EXPECT_EQ(mapping->statistic, "t");
  EXPECT_EQ(mapping->error_df, 22);
  EXPECT_EQ(mapping->arrangements, 2000);
  EXPECT_DOUBLE_EQ(mapping->possible, 2704156.0);
  ASSERT_EQ(mapping->spans.size(), 1u);
  const auto& span = mapping->spans[0];
  EXPECT_NEAR(span.first, 40, 6);
  EXPECT_NEAR(span.last, 60, 6);
  EXPECT_GT(span.extreme, mapping->threshold);
  EXPECT_LE(span.p, 0.05);
  EXPECT_LE(mapping->p, 0.05);
  EXPECT_TRUE(mapping->remark.empty());
}

TEST(MapCurves, TheSignIsThatOfTheFirstLessTheSecond) {
  Random random(12, 0);
  std::vector<data::CycleCurves> groups{random_curves(random, 10, 8.0), random_curves(random, 10, 8.0)};
  add_bump(groups[1], 30, 70, 5.0);
  const auto both = map_curves(groups, {.design = Design::paired, .arrangements = 2000});
  ASSERT_FALSE(both->spans.empty());
  EXPECT_LT(both->spans[0].extreme, 0.0);
  const auto up = map_curves(groups, {.design = Design::paired, .two_sided = false, .arrangements = 2000});
  EXPECT_TRUE(up->spans.empty());
  EXPECT_LT(up->threshold, both->threshold);
}

TEST(MapCurves, ThresholdAndProbabilityOfAllArrangementsByHand) {
  // Differences 1 to 6: of 64 arrangements two reach the observed size, so p = 2 / 64.
  const std::vector<data::CycleCurves> one{numbers({1, 2, 3, 4, 5, 6})};
  const auto mapping = map_curves(one, {.design = Design::one_sample});
  EXPECT_EQ(mapping->arrangements, 64);
  EXPECT_DOUBLE_EQ(mapping->p, 2.0 / 64.0);
  // Three arrangements may exceed it: the two of size 21 do, those of size 19 (-1) do not.
  EXPECT_NEAR(mapping->threshold, (19.0 / 6.0) / std::sqrt((91.0 - 19.0 * 19.0 / 6.0) / 5.0 / 6.0), 1e-9);
  ASSERT_EQ(mapping->spans.size(), 1u);
  EXPECT_DOUBLE_EQ(mapping->spans[0].p, 2.0 / 64.0);
  EXPECT_EQ(mapping->spans[0].first, 0.0);
  EXPECT_EQ(mapping->spans[0].last, 1.0);
  const auto up = map_curves(one, {.design = Design::one_sample, .two_sided = false});
  EXPECT_DOUBLE_EQ(up->p, 1.0 / 64.0);
}

TEST(MapCurves, SaysWhenSoFewCurvesCannotShowAnything) {
  const std::vector<data::CycleCurves> one{numbers({1, 2, 3, 4})};
  const auto mapping = map_curves(one, {.design = Design::one_sample});
  EXPECT_TRUE(std::isnan(mapping->threshold));
  EXPECT_EQ(mapping->remark, "16 arrangements of so few curves cannot show a difference at 0.05; add curves");
  EXPECT_DOUBLE_EQ(mapping->p, 2.0 / 16.0);
  EXPECT_TRUE(mapping->spans.empty());
}

TEST(MapCurves, FewArrangementsOfManyCurvesAreNotFewCurves) {
  Random random(3, 1);
  const std::vector<data::CycleCurves> groups{random_curves(random, 8, 10.0, 11),
                                              random_curves(random, 8, 10.0, 11)};
  const auto few = map_curves(groups, {.design = Design::two_sample, .alpha = 0.01, .arrangements = 20});
  EXPECT_EQ(few->remark, "20 arrangements of all that there are cannot show a difference at 0.01; take more");
  EXPECT_FALSE(few->remark.contains("arrangements of so few curves cannot show"));
  const auto many = map_curves(groups, {.design = Design::two_sample, .alpha = 0.01, .arrangements = 400});
  EXPECT_FALSE(many->remark.contains("cannot show a difference at"));
  EXPECT_FALSE(many->remark.contains("arrangements of all that there are cannot"));
  EXPECT_FALSE(many->remark.contains("no point can be tested: at each one"));
}

TEST(MapCurves, ErrorOverTheWholeCurveIsKept) {
  // 400 null sets: 5 % is 20, and 5 SD of a binomial are 22.
  int found = 0;
  for (std::uint64_t set = 0; set < 400; ++set) {
    Random random(21, set);
    const std::vector<data::CycleCurves> groups{random_curves(random, 8, 10.0, 51),
                                                random_curves(random, 8, 10.0, 51)};
    const auto mapping = map_curves(groups, {.design = Design::two_sample, .arrangements = 200, .seed = set});
    found += !mapping->spans.empty();
    for (const auto& span : mapping->spans) EXPECT_LE(span.p, 0.05);
    EXPECT_EQ(mapping->p <= 0.05, !mapping->spans.empty());
  }
  EXPECT_GT(found, 4);
  EXPECT_LT(found, 42);
}

TEST(MapCurves, MissingPointsAreLeftOutAndEndASpan) {
  Random random(13, 0);
  std::vector<data::CycleCurves> groups{random_curves(random, 10, 8.0), random_curves(random, 10, 8.0)};
  add_bump(groups[0], 20, 80, 6.0);
  groups[1].values[50] = kNaN;
  const auto mapping = map_curves(groups, {.design = Design::two_sample, .arrangements = 1000});
  EXPECT_EQ(mapping->not_tested, 1);
  EXPECT_TRUE(std::isnan(mapping->values[50]));
  ASSERT_GE(mapping->spans.size(), 2u);
  EXPECT_EQ(mapping->spans[0].last, 49.0);
  EXPECT_EQ(mapping->spans[1].first, 51.0);
}

TEST(MapCurves, NothingToTestIsSaid) {
  const std::vector<data::CycleCurves> groups{numbers({1, 1}), numbers({1, 1})};
  const auto mapping = map_curves(groups, {.design = Design::two_sample});
  EXPECT_EQ(mapping->not_tested, 2);
  EXPECT_EQ(mapping->remark,
            "no point can be tested: at each one a curve is missing or all curves are equal");
}

TEST(MapCurves, GroupsMustFitTheDesign) {
  const std::vector<data::CycleCurves> two{numbers({1, 2, 3}), numbers({1, 2})};
  EXPECT_EQ(map_curves(std::span(two).first(1), {.design = Design::two_sample}).error().message,
            "1 groups of curves are given; the design 'two samples' takes 2");
  EXPECT_EQ(map_curves(two, {.design = Design::paired}).error().message,
            "group 'group' has 3 curves and group 'group' 2; pairs need as many in both");
  const std::vector<data::CycleCurves> short_one{numbers({1})};
  EXPECT_EQ(map_curves(short_one, {.design = Design::one_sample}).error().message,
            "group 'group' has 1 curve; need at least 2");
  auto other = numbers({1, 2});
  other.points = 1;
  EXPECT_FALSE(map_curves(std::vector{two[0], other}, {.design = Design::two_sample}));
  EXPECT_EQ(map_curves(two, {.alpha = 5.0}).error().message,
            "alpha is 5; need a probability above 0 and below 1");
  EXPECT_EQ(map_curves(two, {.arrangements = 3}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::analysis
