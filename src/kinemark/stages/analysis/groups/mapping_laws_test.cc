// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What must hold of a comparison of curves whatever the curves are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/groups/mapping.h"
#include "kinemark/stages/analysis/groups/mean_band.h"
#include "kinemark/stages/analysis/groups/testing/random_curves.h"

namespace kinemark::analysis {
namespace {

using testing::random_curves;
using Groups = std::vector<data::CycleCurves>;

constexpr std::int64_t kAll = 100'000;

Groups two(std::uint64_t seed, double higher = 0.0) {
  Random random(seed, 0);
  Groups out{random_curves(random, 6, 6.0, 41), random_curves(random, 6, 6.0, 41)};
  for (double& value : out[0].values) value += higher;
  return out;
}

Groups changed(Groups groups, double factor, double shift) {
  for (auto& group : groups)
    for (double& value : group.values) value = factor * value + shift;
  return groups;
}

void expect_equal(const Mapping& a, const Mapping& b, double sign) {
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t p = 0; p < a.values.size(); ++p) EXPECT_NEAR(a.values[p], sign * b.values[p], 1e-9);
  EXPECT_NEAR(a.threshold, b.threshold, 1e-9);
  EXPECT_DOUBLE_EQ(a.p, b.p);
  ASSERT_EQ(a.spans.size(), b.spans.size());
  for (std::size_t i = 0; i < a.spans.size(); ++i) {
    EXPECT_NEAR(a.spans[i].first, b.spans[i].first, 1e-9);
    EXPECT_NEAR(a.spans[i].extreme, sign * b.spans[i].extreme, 1e-9);
    EXPECT_DOUBLE_EQ(a.spans[i].p, b.spans[i].p);
  }
}

TEST(MappingLaws, UnitAndOriginOfTheCurvesDoNotMatter) {
  for (const Design design : {Design::two_sample, Design::paired, Design::one_way}) {
    const auto groups = two(31, 1.5);
    const MappingOptions options{.design = design, .arrangements = kAll};
    expect_equal(*map_curves(groups, options), *map_curves(changed(groups, 57.3, 12.0), options), 1.0);
  }
}

TEST(MappingLaws, ExchangedGroupsChangeTheSignAlone) {
  const auto groups = two(32, 1.5);
  const Groups other{groups[1], groups[0]};
  for (const Design design : {Design::two_sample, Design::paired}) {
    const MappingOptions options{.design = design, .arrangements = kAll};
    expect_equal(*map_curves(groups, options), *map_curves(other, options), -1.0);
  }
}

TEST(MappingLaws, OrderWithinAGroupDoesNotMatter) {
  const auto groups = two(33, 1.5);
  auto turned = groups;
  for (auto& group : turned) {
    const auto points = static_cast<std::size_t>(group.points);
    for (std::size_t curve = 0; curve < 2; ++curve)
      std::swap_ranges(group.values.begin() + static_cast<std::ptrdiff_t>(curve * points),
                       group.values.begin() + static_cast<std::ptrdiff_t>((curve + 1) * points),
                       group.values.begin() + static_cast<std::ptrdiff_t>((5 - curve) * points));
  }
  const MappingOptions options{.design = Design::two_sample, .arrangements = kAll};
  expect_equal(*map_curves(groups, options), *map_curves(turned, options), 1.0);
}

TEST(MappingLaws, TheSquareOfTIsFOfTwoGroups) {
  const auto groups = two(34, 1.0);
  const auto t = map_curves(groups, {.design = Design::two_sample, .arrangements = kAll});
  const auto f = map_curves(groups, {.design = Design::one_way, .arrangements = kAll});
  for (std::size_t p = 0; p < t->values.size(); ++p)
    EXPECT_NEAR(t->values[p] * t->values[p], f->values[p], 1e-9);
  EXPECT_NEAR(t->threshold * t->threshold, f->threshold, 1e-9);
  EXPECT_DOUBLE_EQ(t->p, f->p);
}

TEST(MappingLaws, PairsAreOneSampleOfDifferences) {
  const auto groups = two(35, 1.0);
  auto difference = groups[0];
  for (std::size_t i = 0; i < difference.values.size(); ++i) difference.values[i] -= groups[1].values[i];
  const auto paired = map_curves(groups, {.design = Design::paired, .arrangements = kAll});
  const auto one = map_curves(Groups{difference}, {.design = Design::one_sample, .arrangements = kAll});
  for (std::size_t p = 0; p < paired->values.size(); ++p)
    EXPECT_NEAR(paired->values[p], one->values[p], 1e-9);
  EXPECT_NEAR(paired->threshold, one->threshold, 1e-9);
}

TEST(MappingLaws, ALargerDifferenceIsNeverLessProbable) {
  double before = 1.0;
  for (const double higher : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    const auto mapping =
        map_curves(two(36, higher), {.design = Design::two_sample, .two_sided = false, .arrangements = kAll});
    EXPECT_LE(mapping->p, before + 1e-12);
    before = mapping->p;
  }
}

TEST(BandLaws, UnitAndOriginAndLevel) {
  const auto curves = two(37)[0];
  const auto band = mean_band(curves), moved = mean_band(changed({curves}, -3.0, 8.0)[0]);
  const auto narrow = mean_band(curves, 0.8);
  for (std::size_t p = 0; p < band->mean.size(); ++p) {
    EXPECT_NEAR(moved->mean[p], -3.0 * band->mean[p] + 8.0, 1e-9);
    EXPECT_NEAR(moved->of_mean(p), 3.0 * band->of_mean(p), 1e-9);
    EXPECT_LT(narrow->of_mean(p), band->of_mean(p));
    EXPECT_LT(band->of_mean(p), band->of_one(p));
  }
}

}  // namespace
}  // namespace kinemark::analysis
