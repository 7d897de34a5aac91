// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/measure.h"

#include <gtest/gtest.h>

#include <set>

namespace kinemark::data {
namespace {

Measure path_length() { return {.id = "path_length", .subject = "LFIN", .value = 1.25}; }

TEST(Measure, UnitsAreThoseOfTheField) {
  EXPECT_EQ(shown_unit(Quantity::length).name, "mm");
  EXPECT_EQ(shown_unit(Quantity::area).name, "cm^2");
  EXPECT_EQ(shown_unit(Quantity::count).name, "");
  EXPECT_DOUBLE_EQ(1.5 * shown_unit(Quantity::length).per_si, 1500.0);
  EXPECT_DOUBLE_EQ(2.0 * shown_unit(Quantity::area).per_si, 20000.0);
  EXPECT_NEAR(3.141592653589793 * shown_unit(Quantity::angle).per_si, 180.0, 1e-12);
  EXPECT_DOUBLE_EQ(1.9 * shown_unit(Quantity::rate).per_si, 114.0);
  EXPECT_DOUBLE_EQ(0.62 * shown_unit(Quantity::share).per_si, 62.0);
}

TEST(Measure, EveryQuantityHasItsOwnName) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(Quantity::count); ++i)
    names.insert(to_string(static_cast<Quantity>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Quantity::count) + 1);
  EXPECT_EQ(to_string(Quantity::angular_momentum), "angular momentum");
  EXPECT_EQ(to_string(Quantity::count), "count");
}

TEST(Measure, AnIntervalHasTheEndsOfItsKind) {
  Measure m = path_length();
  EXPECT_TRUE(m.validate());
  m.interval = {.kind = IntervalKind::two_sided, .low = 1.2, .high = 1.3};
  EXPECT_TRUE(m.validate());
  m.interval = {.kind = IntervalKind::at_most, .high = 1.3};
  EXPECT_TRUE(m.validate());
  m.interval.low = 1.2;
  EXPECT_EQ(m.validate().error().message,
            "measure 'path_length' has an interval of kind 'at most' from 1.2 to 1.3; need the ends of that "
            "kind, in order");
  m.interval = {.kind = IntervalKind::two_sided, .low = 1.3, .high = 1.2};
  EXPECT_FALSE(m.validate());
  m.interval = {.kind = IntervalKind::none, .low = 1.2};
  EXPECT_FALSE(m.validate());
  m.interval = {.kind = IntervalKind::two_sided, .low = 1.2, .high = 1.3, .level = 95.0};
  EXPECT_EQ(m.validate().error().message,
            "measure 'path_length' has an interval of level 95; need one between 0 and 1");
}

TEST(Measure, WhatIsNotDeterminedIsExplained) {
  Measure m = path_length();
  m.value = kNaN;
  EXPECT_EQ(m.validate().error().message, "measure 'path_length' is not determined and does not say why");
  m.remark = "all samples are missing";
  EXPECT_TRUE(m.validate());
  m.share_not_measured = 1.5;
  EXPECT_EQ(m.validate().error().message,
            "measure 'path_length' rests on a share not measured of 1.5; need 0 to 1");
  m.share_not_measured = 1.0;
  m.sd = -0.1;
  EXPECT_EQ(m.validate().error().message, "measure 'path_length' has a deviation of -0.1; need none below 0");
}

TEST(CycleCurves, HoldACycleARow) {
  CycleCurves curves{
      .id = "knee_flexion", .points = 2, .cycles = {"walk Left 1", "walk Left 2"}, .values = {1, 2, 3, 4}};
  EXPECT_TRUE(curves.validate());
  EXPECT_EQ(curves(1, 0), 3.0);
  curves.sd = {0.1, 0.1, 0.1};
  EXPECT_FALSE(curves.validate());
  curves.sd = {0.1, 0.1, 0.1, -0.1};
  EXPECT_EQ(curves.validate().error().message, "curves 'knee_flexion' have a deviation below 0");
  curves.sd.clear();
  curves.values.pop_back();
  EXPECT_EQ(curves.validate().error().message,
            "curves 'knee_flexion' of 2 cycles at 2 points hold 3 values and 0 deviations; need at least 2 "
            "points, 4 "
            "values, and as many deviations or none");
}

}  // namespace
}  // namespace kinemark::data
