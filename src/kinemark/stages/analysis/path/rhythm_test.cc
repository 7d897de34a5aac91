// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/rhythm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using ::testing::ElementsAre;
using testing::kTurn;
using ::testing::Pair;

// Out and back between two places: a minimum-jerk way, a rest, and again.
PathSamples reaches(std::int64_t n, double rate_hz, double way_s, double rest_s) {
  Eigen::VectorXd speed(n), acceleration(n);
  for (std::int64_t i = 0; i < n; ++i) {
    const double t = std::fmod(static_cast<double>(i) / rate_hz, way_s + rest_s) - rest_s;
    speed[i] = testing::minimum_jerk_speed(t / way_s) / way_s;
    acceleration[i] = testing::minimum_jerk_acceleration(t / way_s) / (way_s * way_s);
  }
  return testing::straight_way(rate_hz, speed, acceleration);
}
PathSamples steps(const Eigen::VectorXd& speed) {
  return testing::straight_way(100.0, speed, Eigen::VectorXd::Zero(speed.size()));
}

std::vector<MovementWindow> movements_in(const PathSamples& path) {
  return movements_of(path, speed_of(path));
}

TEST(MovementsOf, ReachesBetweenRestsAreFoundOneByOne) {
  const auto path = reaches(500, 100.0, 0.7, 0.5);
  const auto found = movements_in(path);
  ASSERT_EQ(found.size(), 4u);
  const auto window = movement_window(path, speed_of(path));
  EXPECT_EQ(window.onset_s, found[0].onset_s) << "of the first";
  EXPECT_EQ(window.end_s, found[3].end_s) << "of the last";
  // The speed of a minimum-jerk way crosses 5 % of its peak at u (1 - u) = sqrt(0.05) / 4.
  const double u = 0.5 - std::sqrt(0.25 - std::sqrt(0.05) / 4.0);
  for (std::size_t k = 0; k < 4; ++k) {
    const double begin = 0.5 + 1.2 * static_cast<double>(k);
    EXPECT_NEAR(found[k].onset_s, begin + 0.7 * u, 1e-3) << k;
    EXPECT_NEAR(found[k].end_s, begin + 0.7 * (1.0 - u), 1e-3) << k;
  }
}

TEST(MovementsOf, AShortStopPartsNothingAndAShortJerkIsNone) {
  Eigen::VectorXd speed = Eigen::VectorXd::Ones(300);
  speed.segment(100, 9).setZero();  // 90 ms
  auto found = movements_in(steps(speed));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(std::isnan(found[0].onset_s));
  EXPECT_TRUE(std::isnan(found[0].end_s));
  speed.segment(100, 100).setZero();
  speed.segment(150, 9).setOnes();  // moves for 90 ms
  found = movements_in(steps(speed));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].end_s, 0.9986465, 1e-7);  // 3 t^2 - 2 t^3 = 0.95 from 0.99 s on
  EXPECT_NEAR(found[1].onset_s, 1.9913535, 1e-7);
  EXPECT_TRUE(movements_in({}).empty());
}

TEST(PeriodOf, AnEllipseIsATurnAndAFigureOfEightIsNoHalfOfOne) {
  const auto ellipse = testing::path_of(400, 100.0, testing::ellipse);
  EXPECT_NEAR(period_of(ellipse.v, 100.0).s, 1.0, 1e-3);
  EXPECT_GT(period_of(ellipse.v, 100.0).likeness, 0.999);
  const auto eight = testing::path_of(500, 100.0, [](double t) -> Eigen::Vector3d {
    return {0.2 * std::cos(kTurn * 0.8 * t), 0.18 * std::sin(2.0 * kTurn * 0.8 * t), 0.0};
  });
  EXPECT_NEAR(period_of(eight.v, 100.0).s, 1.25, 2e-3);
}

TEST(PeriodOf, AWayAcrossTheRoomHidesNoStep) {
  const auto walk = testing::path_of(600, 100.0, [](double t) -> Eigen::Vector3d {
    return {1.3 * t + 0.25 * std::sin(kTurn * 0.9 * t), 0.0, 0.05 * std::cos(kTurn * 0.9 * t)};
  });
  EXPECT_NEAR(period_of(walk.v, 100.0).s, 1.0 / 0.9, 2e-3);
}

TEST(PeriodOf, OneReachAndAStraightWayHaveNone) {
  const auto reach = testing::path_of(178, 100.0, testing::reach);
  EXPECT_LT(period_of(reach.v, 100.0).likeness, 0.2);
  const auto straight = testing::path_of(200, 100.0, [](double t) { return Eigen::Vector3d(t, 0.0, 0.0); });
  EXPECT_TRUE(std::isnan(period_of(straight.v, 100.0).s));
  EXPECT_TRUE(std::isnan(period_of(SeriesMatrix::Zero(5, 3), 100.0).s));
}

// A path without a period: white noise through two low-passes of the first order, 8 s at 100 Hz.
SeriesMatrix aimless(std::uint64_t seed) {
  Random random(seed, 5);
  SeriesMatrix v = SeriesMatrix::Zero(800, 3);
  Eigen::RowVector3d once = Eigen::RowVector3d::Zero(), twice = once;
  for (std::int64_t i = -200; i < 800; ++i) {
    once += 0.06 * (Eigen::RowVector3d(random.gaussian(), random.gaussian(), random.gaussian()) - once);
    twice += 0.06 * (once - twice);
    if (i >= 0) v.row(i) = twice;
  }
  return v;
}

TEST(PeriodOf, OfAimlessPathsReachesTheLikenessOfCyclesInOneOfFifty) {
  int like = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed)
    like += period_of(aimless(seed), 100.0).likeness >= kPeriodicLikeness;
  EXPECT_LE(like, 10);
}

TEST(LikenessAfter, IsThatOfTheAutocorrelationAtItsPeriod) {
  const auto ellipse = testing::path_of(400, 100.0, testing::ellipse);
  EXPECT_NEAR(likeness_after(ellipse.v, 100.0, 1.02), period_of(ellipse.v, 100.0).likeness, 1e-6);
  EXPECT_LT(likeness_after(ellipse.v, 100.0, 0.5), 0.0 + 1e-9);
  EXPECT_EQ(likeness_after(ellipse.v, 100.0, 4.0), 0.0);  // beyond its end
  EXPECT_EQ(likeness_after(ellipse.v, 100.0, kNaN), 0.0);
  int like = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    like += likeness_after(aimless(seed), 100.0, 1.3) >= kPeriodicLikeness;
  EXPECT_LE(like, 2);
}

TEST(CyclesAmong, AreAPeriodApartAndAgainBehindAPause) {
  const std::vector<double> crossings{0.0, 1.0, 2.1, 3.0, 7.0, 8.0, 9.1};
  EXPECT_THAT(cycles_among(crossings, 1.0),
              ElementsAre(Pair(0, 1), Pair(1, 2), Pair(2, 3), Pair(4, 5), Pair(5, 6)));
  EXPECT_TRUE(cycles_among({}, 1.0).empty());
  EXPECT_TRUE(cycles_among(std::vector{1.0}, 1.0).empty());
}

TEST(CyclesAmong, OfTwoCrossingsInAPeriodOneRowCounts) {
  // The row of 0.1, 1.1, ... is even, that of 0.4, 1.6, 2.4 is not.
  const std::vector<double> crossings{0.1, 0.4, 1.1, 1.6, 2.1, 2.4, 3.1, 3.55};
  EXPECT_THAT(cycles_among(crossings, 1.0), ElementsAre(Pair(0, 2), Pair(2, 4), Pair(4, 6)));
}

TEST(KindsOf, OutAndBackAndAroundAreThree) {
  const std::vector<Eigen::Vector3d> ways{
      {0.3, 0.0, 0.0}, {-0.29, 0.01, 0.0}, {0.31, 0.03, 0.0}, {0.01, 0.0, 0.02}, {-0.3, 0.0, 0.05}};
  EXPECT_THAT(kinds_of(ways), ElementsAre(0, 1, 0, 2, 1));
  EXPECT_TRUE(kinds_of({}).empty());
}

}  // namespace
}  // namespace kinemark::analysis
