// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

constexpr double kRate = 100.0;

data::Trajectories noisy(const SeriesMatrix& x, double noise_m) {
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = kRate, .frames = x.rows()});
  Random random(5, 0);
  for (std::int64_t f = 0; f < x.rows(); ++f) {
    out.x(f, 0) = x.row(f).transpose() +
                  noise_m * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    out.state[out.index(f, 0)] = data::SampleState::measured;
  }
  return out;
}

TEST(PathCurves, TangentialAccelerationIsTheRateOfTheSpeed) {
  const auto path = differentiate(testing::sampled(400, kRate, testing::ellipse), 10, 380, kRate);
  const auto speed = speed_of(path), acceleration = tangential_acceleration(path);
  for (Eigen::Index i = 1; i + 1 < speed.size(); ++i)
    EXPECT_NEAR(acceleration[i], (speed[i + 1] - speed[i - 1]) * 0.5 * kRate,
                2e-2 * acceleration.cwiseAbs().maxCoeff());
  PathSamples rest{.rate_hz = kRate,
                   .x = SeriesMatrix::Zero(3, 3),
                   .v = SeriesMatrix::Zero(3, 3),
                   .a = SeriesMatrix::Ones(3, 3),
                   .j = SeriesMatrix::Zero(3, 3)};
  EXPECT_EQ(tangential_acceleration(rest).norm(), 0.0);
}

TEST(PathCurves, DeviationsAreThoseOfTheRefits) {
  const auto path = differentiate(testing::sampled(100, kRate, testing::ellipse), 10, 80, kRate);
  CurveSpread spread(path);
  EXPECT_EQ(spread.speed_sd().size(), 0);
  Random random(1, 0);
  for (int k = 0; k < 400; ++k) {
    auto refit = path;
    for (Eigen::Index i = 0; i < refit.v.rows(); ++i) refit.v.row(i) *= 1.0 + 0.02 * random.gaussian();
    spread.add(refit);
  }
  const auto speed = speed_of(path), sd = spread.speed_sd();
  EXPECT_NEAR((sd.array() / speed.array()).mean(), 0.02, 0.0005);
  EXPECT_LT(spread.acceleration_sd().maxCoeff(), 1e-6);
}

TEST(PathCurves, ComeWithTheMeasuresWhereTheyAreAskedFor) {
  const auto markers = noisy(testing::sampled(400, kRate, testing::ellipse), 5e-4);
  EXPECT_TRUE(measure_paths(markers, {.measures = {"peak_speed"}, .refits = 39})->curves.empty());
  const auto measured = measure_paths(markers, {.measures = {"peak_speed"}, .refits = 39, .curves = true});
  ASSERT_TRUE(measured);
  ASSERT_EQ(measured->curves.size(), 1u);
  const auto& curves = measured->curves[0];
  EXPECT_EQ(curves.subject, "P");
  EXPECT_NEAR(curves.start_s, 0.08, 1e-12);
  EXPECT_EQ(curves.speed.size(), 384);
  EXPECT_EQ(curves.along.rows(), 384);
  EXPECT_EQ(curves.measured.size(), 384u);
  EXPECT_GE(curves.cycles.size(), 2u);
  EXPECT_TRUE(std::isnan(curves.window.onset_s));
  EXPECT_GT(curves.speed_sd.minCoeff(), 0.0);
  EXPECT_NEAR(curves.along.colwise().mean().norm(), 0.0, 1e-12);
}

TEST(PathCurves, ADiscreteMovementHasOnsetAndEnd) {
  const auto markers = noisy(testing::sampled(300, kRate, testing::reach), 5e-4);
  const auto measured = measure_paths(markers, {.measures = {"onset"}, .refits = 39, .curves = true});
  ASSERT_TRUE(measured);
  ASSERT_EQ(measured->curves.size(), 1u);
  const auto& curves = measured->curves[0];
  EXPECT_LT(curves.window.onset_s, curves.window.end_s);
  EXPECT_TRUE(curves.cycles.empty());
}

}  // namespace
}  // namespace kinemark::analysis
