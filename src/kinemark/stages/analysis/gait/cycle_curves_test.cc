// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/cycle_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using data::Side;

// sin over cycles of changing duration: the same curve of each, whatever its time.
class CycleCurvesTest : public ::testing::Test {
 protected:
  CycleCurvesTest() {
    double start = 0.313;
    for (const double duration : {1.0, 1.1, 0.93}) {
      cycles_.push_back({.side = Side::left, .start_s = start, .end_s = start + duration});
      start += duration;
    }
    cycles_.push_back({.side = Side::right, .start_s = 0.8, .end_s = 1.8});
    for (int i = 0; i < 4000; ++i) {
      const double t = i / 1000.0;
      series_.time_s.push_back(t);
      double value = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        if (t >= cycles_[c].start_s && t <= cycles_[c].end_s)
          value = std::sin(2.0 * std::numbers::pi * (t - cycles_[c].start_s) /
                           (cycles_[c].end_s - cycles_[c].start_s)) +
                  0.1 * static_cast<double>(c);
      series_.values.push_back(value);
    }
    series_.id = "knee";
  }
  CycleSeries series_;
  std::vector<GaitCycle> cycles_;
};

TEST_F(CycleCurvesTest, TakeTheirTimeOff) {
  const auto curves = cut_into_cycles(series_, cycles_, Side::left);
  EXPECT_TRUE(curves.validate());
  ASSERT_EQ(curves.count(), 3);
  EXPECT_EQ(curves.cycles[2], "Left 3");
  EXPECT_EQ(curves.context, "Left");
  for (std::int64_t c = 0; c < 3; ++c)
    for (std::int64_t p = 5; p < 96; ++p)
      EXPECT_NEAR(curves(c, p),
                  std::sin(0.02 * std::numbers::pi * static_cast<double>(p)) + 0.1 * static_cast<double>(c),
                  1e-5);
}

TEST_F(CycleCurvesTest, MeanAndSdAreThoseOfTheCycles) {
  const auto mean = mean_of_cycles(cut_into_cycles(series_, cycles_, Side::left));
  EXPECT_NEAR(mean.mean[25], 1.1, 1e-5);
  EXPECT_NEAR(mean.sd[25], 0.1, 1e-5);  // of 1.0, 1.1, 1.2
  EXPECT_EQ(mean.cycles[25], 3);
  const auto one = mean_of_cycles(cut_into_cycles(series_, cycles_, Side::right));
  EXPECT_TRUE(std::isnan(one.sd[50]));
}

TEST_F(CycleCurvesTest, WhatIsMissingStaysMissing) {
  for (std::size_t i = 600; i < 700; ++i) series_.values[i] = kNaN;
  series_.sd.assign(series_.values.size(), 0.01);
  auto curves = cut_into_cycles(series_, cycles_, Side::left);
  EXPECT_TRUE(std::isnan(curves(0, 33)));
  EXPECT_EQ(mean_of_cycles(curves).cycles[33], 2);
  EXPECT_NEAR(curves.sd[0], 0.01, 1e-12);
  // A hole in the rows themselves, and a series that ends early.
  series_.sd.clear();
  series_.values.erase(series_.values.begin() + 600, series_.values.begin() + 700);
  series_.time_s.erase(series_.time_s.begin() + 600, series_.time_s.begin() + 700);
  series_.values.resize(2000), series_.time_s.resize(2000);
  curves = cut_into_cycles(series_, cycles_, Side::left);
  EXPECT_TRUE(std::isnan(curves(0, 33)));
  EXPECT_TRUE(std::isnan(curves(2, 50)));
}

}  // namespace
}  // namespace kinemark::analysis
