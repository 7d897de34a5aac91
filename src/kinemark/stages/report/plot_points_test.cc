// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/plot_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::report::internal {
namespace {

using testing::ElementsAre;

TEST(PlotPoints, KeepsEveryFrameThatFits) {
  const PlotPoints points(4, 4);
  EXPECT_EQ(points.step(), 1);
  EXPECT_THAT(points.extremes(std::vector<double>{3, 1, 4, 1}), ElementsAre(3, 1, 4, 1));
  EXPECT_THAT(points.largest(std::vector<double>{3, 1, 4, 1}), ElementsAre(3, 1, 4, 1));
  EXPECT_THAT(points.worst(std::vector<std::uint8_t>{0, 1, 2, 0}), ElementsAre(0, 1, 2, 0));
}

TEST(PlotPoints, NeverExceedsItsBoundAndCoversAllFrames) {
  for (const std::int64_t max_points : {2, 3, 4, 5, 100, 101, 20000})
    for (const std::int64_t frames : {0, 1, 2, 3, 5, 99, 100, 101, 102, 999, 20001, 864000}) {
      const PlotPoints points(frames, max_points);
      EXPECT_LE(points.size(), std::max(frames <= max_points ? frames : 0, max_points))
          << frames << " " << max_points;
      EXPECT_GE(points.size() * points.step(), frames);
      EXPECT_TRUE(points.step() == 1 || points.size() % 2 == 0);
    }
}

TEST(PlotPoints, PairsHoldTheExtremesInTheOrderInWhichTheyCame) {
  const PlotPoints points(8, 4);
  EXPECT_EQ(points.step(), 2);
  EXPECT_THAT(points.extremes(std::vector<double>{0, 9, -3, 1, 2, -7, 5, 0}), ElementsAre(9, -3, -7, 5));
}

TEST(PlotPoints, ThinningLosesNoPeak) {
  Random random(3, 0);
  for (const std::int64_t frames : {101, 1000, 12345}) {
    std::vector<double> values(static_cast<std::size_t>(frames));
    for (double& v : values) v = random.gaussian();
    values[static_cast<std::size_t>(random.uniform() * static_cast<double>(frames))] = 50.0;
    values[static_cast<std::size_t>(frames - 1)] = -60.0;
    const auto thin = PlotPoints(frames, 64).extremes(values);
    EXPECT_EQ(*std::ranges::max_element(thin), 50.0F);
    EXPECT_EQ(*std::ranges::min_element(thin), -60.0F);
  }
}

TEST(PlotPoints, MissingFramesCountOnlyWhereNothingElseIs) {
  const auto thin =
      PlotPoints(8, 4).extremes(std::vector<double>{kNaN, 2, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN});
  EXPECT_EQ(thin[0], 2.0F);
  EXPECT_EQ(thin[1], 2.0F);
  EXPECT_TRUE(std::isnan(thin[2]) && std::isnan(thin[3]));
}

TEST(PlotPoints, ErrorBarsAreTheWidestOfTheirPair) {
  EXPECT_THAT(PlotPoints(8, 4).largest(std::vector<double>{1, kNaN, 5, 2, 1, 1, 1, 3}),
              ElementsAre(5, 5, 3, 3));
}

TEST(PlotPoints, CodesAreTheWorstOfTheirPoint) {
  EXPECT_THAT(PlotPoints(8, 4).worst(std::vector<std::uint8_t>{0, 3, 1, 0, 0, 0, 2, 1}),
              ElementsAre(3, 1, 0, 2));
  // Nine frames on four points of three: the last point has none and repeats the one before.
  EXPECT_THAT(PlotPoints(9, 4).worst(std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0, 0, 0, 2}),
              ElementsAre(0, 1, 2, 2));
}

TEST(PlotPoints, RefusesArraysOfAnotherLength) {
  const PlotPoints points(8, 4);
  EXPECT_THROW((void)points.extremes(std::vector<double>(7)), ContractError);
  EXPECT_THROW((void)points.largest(std::vector<double>(9)), ContractError);
  EXPECT_THROW((void)points.worst(std::vector<std::uint8_t>(7)), ContractError);
  EXPECT_THROW(PlotPoints(8, 1), ContractError);
}

}  // namespace
}  // namespace kinemark::report::internal
