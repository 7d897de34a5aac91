// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/plot_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::report {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(PlotAxis, RangesGetRoomAndTicksAreRound) {
  PlotAxis axis{.from = 0.0, .to = 108.0};
  for (const double v : {0.0, 100.0, std::nan("")}) axis.include(v);
  axis.settle();
  EXPECT_DOUBLE_EQ(axis.low, -4.0);
  EXPECT_DOUBLE_EQ(axis.at(50.0), 54.0);
  EXPECT_THAT(axis.ticks(), ElementsAre(0.0, 20.0, 40.0, 60.0, 80.0, 100.0));
  EXPECT_THAT(axis.ticks(3.0), ElementsAre(0.0, 50.0, 100.0));
}

TEST(PlotAxis, NothingAndOneValueHaveARange) {
  PlotAxis nothing;
  nothing.settle();
  EXPECT_LT(nothing.low, nothing.high);
  PlotAxis one;
  one.include(7.0);
  one.settle();
  EXPECT_DOUBLE_EQ(one.low, 6.5);
  EXPECT_THAT(one.ticks(), Not(IsEmpty()));
}

TEST(PlotAxis, LogarithmsShowPositiveValuesAlone) {
  PlotAxis axis{.logarithmic = true};
  for (const double v : {-1.0, 0.0, 1.0, 100.0}) axis.include(v);
  EXPECT_DOUBLE_EQ(axis.low, 0.0);
  EXPECT_DOUBLE_EQ(axis.high, 2.0);
  EXPECT_FALSE(axis.shows(0.0));
  EXPECT_THAT(axis.ticks(), ElementsAre(1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0));
}

TEST(PlotAxis, ManyPowersOfTenAreNotCrowded) {
  PlotAxis axis{.low = -5.0, .high = 1.0, .logarithmic = true};
  EXPECT_EQ(axis.ticks(5.0).size(), 7U) << "one to a power";
  axis.low = -30.0;
  EXPECT_LE(axis.ticks(5.0).size(), 10U);
  EXPECT_DOUBLE_EQ(axis.ticks(5.0).back(), 1.0);
}

TEST(PlotAxis, EqualUnitsWidenTheNarrowAxisAboutItsMiddle) {
  PlotAxis x{.low = 0.0, .high = 10.0, .from = 0.0, .to = 100.0},
      y{.low = 0.0, .high = 10.0, .from = 50.0, .to = 0.0};
  make_equal(x, y);
  EXPECT_THAT(x.low, DoubleNear(-5.0, 1e-12));
  EXPECT_THAT(x.high, DoubleNear(15.0, 1e-12));
  EXPECT_DOUBLE_EQ(y.high, 10.0);
}

}  // namespace
}  // namespace kinemark::report
