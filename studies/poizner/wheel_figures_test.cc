// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_figures.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

PoiznerStudy wheel_of_one_metre() {
  PoiznerSeed seed;
  WheelOutcome wheel;
  wheel.our_path.resize(3, 200);
  for (int f = 0; f < 200; ++f)
    wheel.our_path.col(f) << 0.5 * std::cos(0.1 * f), 0.5 * std::sin(0.1 * f), 0.1 * std::cos(0.1 * f);
  wheel.ours.circle_error_m = 0.001;
  seed.wheels.push_back(wheel);
  PoiznerStudy study;
  study.seeds.push_back(seed);
  for (const char* what :
       {"median error of the diameter", "scatter of the diameter", "largest error of the diameter",
        "scatter across the plane", "ratio of the axes, by spread over all samples"})
    study.table.rows.push_back(
        {.quantity = fmt::format("{}: {}", wheel_name(0), what), .unit = "mm", .paper = 0.7, .ours = 0.125});
  return study;
}

TEST(WheelFigures, DisplacementIsInMillimetresOverSeconds) {
  const auto figures = wheel_figures(wheel_of_one_metre());
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[0].number, 4);
  ASSERT_EQ(figures[0].curves.size(), 3U);
  EXPECT_NEAR(figures[0].curves[1].points(10, 0), 0.1, 1e-12);
  EXPECT_NEAR(figures[0].curves[1].points(10, 1), 500.0 * std::sin(1.0), 1e-9);
  EXPECT_NEAR(figures[0].numbers.front().ours, 393.0, 1e-9);
}

TEST(WheelFigures, TheBoxHoldsThePathAndTheSummaryTheRowsOfTheTable) {
  const auto figures = wheel_figures(wheel_of_one_metre());
  const auto& five = figures[1];
  EXPECT_EQ(five.number, 5);
  EXPECT_EQ(five.numbers.size(), 5U);
  EXPECT_EQ(five.numbers[1].paper, 0.7);
  const auto& box = five.curves.back().points;
  EXPECT_NEAR(box(1, 0) - box(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(box(1, 2) - box(0, 2), 0.2, 1e-3);
  const auto svg = report::figure_svg(five.figure);
  for (const char* part : {"Box 1000 x 1000 x 200 mm", "Axes 100 mm", "Best-fit plane", ">0.125<", ">0.7<",
                           "scatter of the diameter"})
    EXPECT_THAT(svg, HasSubstr(part));
}

}  // namespace
}  // namespace kinemark::studies
