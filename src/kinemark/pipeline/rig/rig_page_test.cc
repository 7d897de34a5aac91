// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/rig_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"

namespace kinemark::pipeline {
namespace {

/// Points every 10 mm on a square of 1 m by 0.5 m in x and z; the SD grows with x.
data::Trajectories square() {
  auto t = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 100 * 50});
  t.covariance.assign(static_cast<std::size_t>(6 * t.frames()), 0.0);
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    const std::int64_t column = f % 100, row = f / 100;
    const double x = 0.005 + 0.01 * static_cast<double>(column), z = -0.245 + 0.01 * static_cast<double>(row);
    t.x(f, 0) = Eigen::Vector3d(x, 7.0, z);
    t.state[t.index(f, 0)] = data::SampleState::measured;
    const double variance = std::pow(1e-3 * (1.0 + x), 2) / 3.0;
    for (const int k : {0, 3, 5}) t.covariance[static_cast<std::size_t>(6 * f + k)] = variance;
  }
  return t;
}

TEST(PrecisionMap, CellsHoldTheMedianOfTheirPoints) {
  const auto map = precision_map(square(), 1);
  EXPECT_EQ(map.axes, (std::array{0, 2}));
  EXPECT_DOUBLE_EQ(map.cell_m, 0.05);
  ASSERT_EQ(map.columns, 20);
  ASSERT_EQ(map.rows, 10);
  EXPECT_NEAR(map.first[0], 0.0, 1e-12);
  EXPECT_NEAR(map.first[1], -0.25, 1e-12);
  for (std::int64_t row = 0; row < map.rows; ++row)
    for (std::int64_t column = 0; column < map.columns; ++column) {
      const auto i = static_cast<std::size_t>(row * map.columns + column);
      EXPECT_EQ(map.samples[i], 25);
      EXPECT_NEAR(map.sd_m[i], 1e-3 * (1.0 + 0.05 * (static_cast<double>(column) + 0.5)), 1e-9);
    }
}

TEST(PrecisionMap, WhatIsAbsentOrWithoutCovarianceDoesNotCount) {
  auto t = square();
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (t.x(f, 0).x() < 0.5) t.set_missing(f, 0, data::SampleState::rejected);
  }
  const auto map = precision_map(t, 1);
  EXPECT_NEAR(map.first[0], 0.5, 1e-12);
  t.covariance.clear();
  const auto nothing = precision_map(t, 1);
  EXPECT_EQ(nothing.columns, 0);
  EXPECT_DOUBLE_EQ(nothing.cell_m, 0.0);
}

TEST(PrecisionMap, ASinglePointHasACell) {
  auto t = square();
  for (std::int64_t f = 1; f < t.frames(); ++f) t.set_missing(f, 0, data::SampleState::missing);
  const auto map = precision_map(t, 2);
  EXPECT_EQ(map.axes, (std::array{0, 1}));
  EXPECT_EQ(map.columns, 1);
  EXPECT_EQ(map.rows, 1);
  EXPECT_EQ(map.samples, std::vector<std::int64_t>{1});
}

using ::testing::HasSubstr;
using ::testing::Not;

data::Rig one_camera(const Eigen::Vector3d& at) {
  data::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].name = "left";
  rig.cameras[0].cam_from_world.translation = -at;
  return rig;
}

TEST(RigPage, ACalibrationShowsBothPositionsOfACameraAndWhatToTurn) {
  CalibrateJob job;
  job.inputs = {"lab/tree.mcap"};
  CalibrateOutcome outcome;
  outcome.alignment = calibration::Alignment{};
  outcome.alignment->next = "Turn camera left by 2 degrees.";
  const auto nominal = one_camera({0.0, 0.0, 0.0}), found = one_camera({0.0, 0.0, 0.25});
  const auto page = calibrate_page(job, outcome, nominal, found);
  EXPECT_THAT(page, HasSubstr("Turn camera left by 2 degrees."));
  EXPECT_THAT(page, HasSubstr(R"("centre_m":[0.0,0.0,0.25])"));
  EXPECT_THAT(page, HasSubstr(R"("nominal":true)"));
  EXPECT_THAT(page, HasSubstr(R"("centre_sd_mm":null)"));
  outcome.alignment->aligned = true;
  EXPECT_THAT(calibrate_page(job, outcome, nominal, found), Not(HasSubstr("camera is to be turned")));
}

TEST(RigPage, AReconstructionJudgesEachLed) {
  ReconstructOutcome outcome;
  outcome.frames = 100;
  outcome.written = {"points.c3d"};
  outcome.found.leds = {{.name = "hand", .frames = 100, .located = 100},
                        {.name = "wrist", .frames = 100, .located = 70, .occluded = 25, .inconsistent = 5},
                        {.name = "lost", .frames = 100, .occluded = 100}};
  const auto points = data::Trajectories::all_missing({"hand", "wrist", "lost"},
                                                      {.rate_hz = 100.0, .t0_s = 0.0, .frames = 100});
  const auto page = reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points);
  EXPECT_THAT(page, HasSubstr(R"("verdict":"attention")"));
  EXPECT_THAT(page, HasSubstr("1 LED located in no frame"));
  EXPECT_THAT(page, HasSubstr("1 LED located in less than 80 % of the frames"));
  EXPECT_THAT(page,
              HasSubstr("wrist: the cameras contradict each other in 5 of 100 frames; no point there."));
  EXPECT_THAT(page, HasSubstr(R"("precision":[null,null])"));
  EXPECT_THAT(page, Not(HasSubstr("light_curves")));
  outcome.found.lights.resize(3);
  for (auto& light : outcome.found.lights) light.seen.assign(100, kNaN);
  outcome.found.lights[0].source = reconstruction::LightSource::direction;
  outcome.found.lights[0].seen[50] = 0.5;
  EXPECT_THAT(
      reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points),
      HasSubstr(R"("light_curves":[{"led":"hand","cameras":["left"],"time_s":[0.5],"seen":[[0.5]]}])"));
  outcome.found.leds.resize(1);
  EXPECT_THAT(reconstruct_page({}, outcome, one_camera({0.0, 0.0, 0.0}), points),
              HasSubstr(R"("verdict":"good")"));
}

}  // namespace

}  // namespace kinemark::pipeline
