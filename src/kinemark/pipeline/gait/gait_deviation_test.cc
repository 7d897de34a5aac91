// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_deviation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/pipeline/gait/testing/known_curves.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::ElementsAre;

constexpr std::array kNine = {"PelvisAngles x", "PelvisAngles y", "PelvisAngles z",
                              "HipAngles x",    "HipAngles y",    "HipAngles z",
                              "KneeAngles x",   "AnkleAngles x",  "FootProgressAngles z"};

// The norm is the known mean curve, shifted by `shift(i)` deg for variable i.
template <class Shift>
GaitNorms norms_beside(const Shift& shift) {
  GaitNorms out;
  for (std::size_t i = 0; i < kNine.size(); ++i) {
    NormCurve norm{.name = kNine[i], .unit = "deg", .meaning = "m", .source = "s"};
    for (int p = 0; p <= 100; ++p) {
      const double mean = testing::known_angle_deg(1, 3, p / 100.0) + shift(i);
      norm.at.push_back(p);
      norm.mean.push_back(mean);
      norm.low.push_back(mean - 1.0);
      norm.high.push_back(mean + 1.0);
    }
    out.curves.push_back(std::move(norm));
  }
  return out;
}

GaitDeviation deviation_of(const std::vector<SheetInput>& curves, const GaitNorms& norms) {
  return gait_deviation(make_gait_sheet("walk", curves, testing::known_gait(), norms));
}

TEST(GaitDeviation, AShiftOfAllByThreeDegreesScoresThree) {
  const auto out = deviation_of(testing::known_walk(), norms_beside([](std::size_t) { return 3.0; }));
  ASSERT_EQ(out.scores.size(), 9u);
  for (const auto& score : out.scores)
    for (const double v : score.value_deg) EXPECT_NEAR(v, 3.0, 1e-9) << score.title;
  EXPECT_NEAR(out.side_deg[0], 3.0, 1e-9);
  EXPECT_NEAR(out.side_deg[1], 3.0, 1e-9);
  EXPECT_NEAR(out.both_deg, 3.0, 1e-9);
  EXPECT_TRUE(out.lacking.empty());
}

TEST(GaitDeviation, ThePelvisCountsOnceForBothSides) {
  // 5 deg in the pelvis alone: of nine, three are 5; of fifteen, three are 5.
  const auto out =
      deviation_of(testing::known_walk(), norms_beside([](std::size_t i) { return i < 3 ? 5.0 : 0.0; }));
  EXPECT_NEAR(out.side_deg[0], 5.0 * std::sqrt(3.0 / 9.0), 1e-9);
  EXPECT_NEAR(out.both_deg, 5.0 * std::sqrt(3.0 / 15.0), 1e-9);
}

TEST(GaitDeviation, ASineScoresItsRootMeanSquare) {
  auto norms = norms_beside([](std::size_t) { return 0.0; });
  auto& knee = norms.curves[6];
  for (std::size_t p = 0; p < knee.mean.size(); ++p)
    knee.mean[p] += 4.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(p) / 100.0);
  const auto out = deviation_of(testing::known_walk(), norms);
  EXPECT_EQ(out.scores[6].title, "Knee flexion");
  EXPECT_NEAR(out.scores[6].value_deg[0], 4.0 * std::sqrt(50.0 / 101.0),
              1e-9);  // 101 points, the first twice
}

TEST(GaitDeviation, WithoutOneOfTheNineThereIsNoScoreButAProfile) {
  auto curves = testing::known_walk();
  std::erase_if(curves, [](const SheetInput& one) { return one.curves.id == "RKneeAngles x"; });
  const auto out = deviation_of(curves, norms_beside([](std::size_t) { return 1.0; }));
  EXPECT_NEAR(out.side_deg[0], 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(out.side_deg[1]));
  EXPECT_TRUE(std::isnan(out.both_deg));
  EXPECT_THAT(out.lacking, ElementsAre("Knee flexion"));
}

TEST(GaitDeviation, ANormWithoutMeansHasNone) {
  auto norms = norms_beside([](std::size_t) { return 1.0; });
  for (auto& curve : norms.curves) curve.mean.assign(curve.mean.size(), kNaN);
  EXPECT_TRUE(deviation_of(testing::known_walk(), norms).scores.empty());
  EXPECT_TRUE(deviation_of(testing::known_walk(), {}).scores.empty());
}

TEST(GaitDeviation, ACurveWithAGapHasNoScore) {
  auto curves = testing::known_walk();
  for (auto& one : curves)
    if (one.curves.id == "LHipAngles x")
      for (std::size_t c = 0; c < 3; ++c) one.curves.values[101 * c + 40] = kNaN;
  const auto out = deviation_of(curves, norms_beside([](std::size_t) { return 1.0; }));
  EXPECT_TRUE(std::isnan(out.scores[3].value_deg[0]));
  EXPECT_NEAR(out.scores[3].value_deg[1], 1.0, 1e-9);
}

}  // namespace
}  // namespace kinemark::pipeline
