// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/balance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace kinemark::analysis {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::ElementsAre;

TEST(Balance, LevelDirectionsMakeARightHandedFrameWithUp) {
  for (const Vector3d& up : {Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(0, 0, -1)}) {
    const auto level = level_of(up);
    EXPECT_LT((level.e1.cross(level.e2) - up).norm(), 1e-12);
    EXPECT_LT(level(up).norm(), 1e-12);
  }
  EXPECT_EQ(level_of({0, 0, 1}).e1, Vector3d::UnitX());
}

TEST(Balance, TheHullOfPointsIsTheirCorners) {
  const auto hull = convex_hull({{0, 0}, {1, 1}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {0, 0}});
  EXPECT_THAT(hull, ElementsAre(Vector2d(0, 0), Vector2d(2, 0), Vector2d(2, 2), Vector2d(0, 2)));
  EXPECT_EQ(convex_hull({{0, 0}, {2, 2}, {1, 1}}).size(), 2u);
  EXPECT_TRUE(convex_hull({}).empty());
}

TEST(Balance, TheDistanceFromTheBorderHasItsSign) {
  const auto square = convex_hull({{0, 0}, {2, 0}, {2, 2}, {0, 2}});
  EXPECT_DOUBLE_EQ(distance_inside({1.0, 0.5}, square), 0.5);
  EXPECT_DOUBLE_EQ(distance_inside({1.0, -0.5}, square), -0.5);
  EXPECT_DOUBLE_EQ(distance_inside({5.0, 6.0}, square), -5.0);
  EXPECT_DOUBLE_EQ(distance_inside({1.0, 1.0}, convex_hull({{0, 0}, {2, 0}})), -1.0);
  EXPECT_TRUE(std::isnan(distance_inside({0, 0}, {})));
}

TEST(Balance, TheExtrapolatedCentreOfAFallingPendulumRunsAwayFromIts) {
  // x = x0 cosh(w t) about a foot at 0: the extrapolated centre is x0 exp(w t).
  const double l = 0.9, w = std::sqrt(9.81 / l), t = 0.3;
  const Vector2d x(0.02 * std::cosh(w * t), 0.0), v(0.02 * w * std::sinh(w * t), 0.0);
  EXPECT_NEAR(extrapolated(x, v, l, 9.81).x(), 0.02 * std::exp(w * t), 1e-12);
}

/// Two feet, each a square of 0.1 m, 0.2 m apart along z (up is y, travel along x: z is to the right).
struct Stance {
  BodySeries series;
  BodyRecord record;
  Eigen::MatrixX<bool> contact = Eigen::MatrixX<bool>::Constant(10, 2, true);

  explicit Stance(double speed) {
    record.time = {.rate_hz = 100.0, .frames = 10};
    record.gravity = 9.81;
    series.q.setZero(10, 1);
    series.centre.setZero(10, 3);
    series.centre.col(1).setConstant(0.981);
    series.centre_velocity.setZero(10, 3);
    series.centre_velocity.col(0).setConstant(speed);
    for (int side = 0; side < 2; ++side)
      for (const double x : {-0.05, 0.05})
        for (const double z : {-0.05, 0.05}) {
          Eigen::MatrixX3d point = Eigen::MatrixX3d::Zero(10, 3);
          point.col(0).setConstant(x);
          point.col(2).setConstant(z + (side == 0 ? -0.1 : 0.1));
          series.outline[static_cast<std::size_t>(side)].push_back(point);
        }
  }
};

TEST(Balance, MarginsByHand) {
  const Stance still(0.0);
  EXPECT_NEAR(stability_margins(still.series, still.record, still.contact, 2, 5)[3], 0.05, 1e-12);
  // 0.981 m high: v / sqrt(10 / s^2) before it.
  const Stance walks(0.5);
  const double before = 0.5 / std::sqrt(10.0);
  EXPECT_NEAR(stability_margins(walks.series, walks.record, walks.contact, 2, 5)[0], 0.05 - before, 1e-12);
  EXPECT_NEAR(lateral_margins(walks.series, walks.record, walks.contact, data::Side::left, 2, 5)[0], 0.15,
              1e-12);
  EXPECT_NEAR(lateral_margins(walks.series, walks.record, walks.contact, data::Side::right, 2, 5)[0], 0.15,
              1e-12);
  EXPECT_TRUE(
      std::isnan(lateral_margins(still.series, still.record, still.contact, data::Side::right, 2, 5)[0]))
      << "what does not travel has no sideways";
}

TEST(Balance, WhereNoFootStandsThereIsNoMargin) {
  Stance flies(1.0);
  flies.contact.row(4).setConstant(false);
  flies.contact(5, 0) = false;
  const auto margins = stability_margins(flies.series, flies.record, flies.contact, 2, 6);
  EXPECT_TRUE(std::isnan(margins[2]));
  EXPECT_TRUE(std::isfinite(margins[1]));
  const auto left = lateral_margins(flies.series, flies.record, flies.contact, data::Side::left, 2, 6);
  EXPECT_TRUE(std::isnan(left[3]));
  EXPECT_TRUE(std::isfinite(left[1]));
}

TEST(Balance, AFootStandsWhileItIsLowAndSlow) {
  Stance steps(0.0);
  for (auto& point : steps.series.outline[0])
    for (int f = 0; f < 10; ++f) point(f, 1) = f < 5 ? 0.0 : 0.02 * (f - 4);
  const auto contact = feet_on_ground(steps.series, Vector3d::UnitY(), 100.0);
  EXPECT_TRUE(contact(0, 0));
  EXPECT_TRUE(contact(2, 0));
  EXPECT_FALSE(contact(6, 0)) << "2 m/s upwards";
  EXPECT_FALSE(contact(9, 0));
  EXPECT_TRUE(contact.col(1).all());
}

}  // namespace
}  // namespace kinemark::analysis
