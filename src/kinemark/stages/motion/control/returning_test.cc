// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/walker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/motion/control/internal/goals.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr double kEase_s = 0.1, kBegun_s = 2.0;
const Vector3d kMiss(0.2, -0.1, 0.05), kRate(-1.0, 0.5, 3.0);

/// A goal at rest in the origin, as the body sees it at a time.
GoalValues seen(ReturningMarkers& returning, double time_s, double weight = 1.0) {
  GoalValues goal(1);
  goal.weight[0] = weight;
  returning.apply(time_s, goal);
  return goal;
}

ReturningMarkers led() {
  ReturningMarkers returning(1, kEase_s);
  returning.lead(0, kBegun_s, kMiss, kRate);
  return returning;
}

double far(const Eigen::Matrix3Xd& a, const Vector3d& b) { return (a.col(0) - b).norm(); }

TEST(ReturningMarkers, LeadFromPositionAndSpeedOfTheBodyToTheGoal) {
  auto returning = led();
  const auto begin = seen(returning, kBegun_s), end = seen(returning, kBegun_s + kEase_s * (1.0 - 1e-9));
  EXPECT_LT(far(begin.x, kMiss), 1e-12);
  EXPECT_LT(far(begin.v, kRate), 1e-12);
  EXPECT_LT(end.x.norm(), 1e-9);
  EXPECT_LT(end.v.norm(), 1e-6);
  const auto after = seen(returning, kBegun_s + kEase_s);
  EXPECT_TRUE(after.x.isZero(0.0) && after.v.isZero(0.0) && after.a.isZero(0.0));
}

TEST(ReturningMarkers, PositionSpeedAndAccelerationBelongTogether) {
  auto returning = led();
  const double h = 1e-5;
  for (const double t : {0.01, 0.05, 0.09}) {
    const auto before = seen(returning, kBegun_s + t - h), now = seen(returning, kBegun_s + t),
               after = seen(returning, kBegun_s + t + h);
    EXPECT_LT(far(now.v, (after.x.col(0) - before.x.col(0)) / (2.0 * h)), 1e-5) << t;
    EXPECT_LT(far(now.a, (after.v.col(0) - before.v.col(0)) / (2.0 * h)), 1e-3) << t;
  }
}

TEST(ReturningMarkers, NeverAskForMoreThanTheyMust) {
  // From rest, a cubic over T needs 6 miss / T^2 at most; a critically damped spring of omega = 100 / s would
  // begin with 1e4 miss.
  ReturningMarkers returning(1, kEase_s);
  returning.lead(0, kBegun_s, kMiss, Vector3d::Zero());
  double most = 0.0;
  for (int i = 0; i <= 100; ++i) most = std::max(most, seen(returning, kBegun_s + 0.001 * i).a.col(0).norm());
  EXPECT_LE(most, 6.0 * kMiss.norm() / (kEase_s * kEase_s) * (1.0 + 1e-9));
}

TEST(ReturningMarkers, AMarkerIsNewOnceForEveryTimeThatItReturns) {
  ReturningMarkers returning(2, kEase_s);
  Eigen::VectorXd weight(2);
  weight << 1.0, 0.0;
  returning.start(weight);
  EXPECT_FALSE(returning.is_new(0, weight));
  EXPECT_FALSE(returning.is_new(1, weight));
  weight[1] = 0.01;
  EXPECT_TRUE(returning.is_new(1, weight));
  returning.lead(1, 0.0, kMiss, kRate);
  EXPECT_FALSE(returning.is_new(1, weight));
  GoalValues goal(2);
  goal.weight << 1.0, 0.0;  // gone again, in the middle of its return
  returning.apply(0.05, goal);
  EXPECT_TRUE(goal.x.isZero(0.0));
  EXPECT_TRUE(returning.is_new(1, weight));
  EXPECT_FALSE(returning.is_new(0, weight));
}

TEST(ReturningMarkers, AStartForgetsAllLeads) {
  auto returning = led();
  returning.start(Eigen::VectorXd::Ones(1));
  EXPECT_TRUE(seen(returning, kBegun_s + 0.02).x.isZero(0.0));
}

TEST(SmoothStep, IsLevelAndStillOutsideItsRange) {
  EXPECT_EQ(smooth_step(-3.0), 0.0);
  EXPECT_EQ(smooth_step(7.0), 1.0);
  EXPECT_DOUBLE_EQ(smooth_step(0.5), 0.5);
  for (const double u : {0.1, 0.37, 0.8}) EXPECT_NEAR(smooth_step(u) + smooth_step(1.0 - u), 1.0, 1e-15);
  EXPECT_LT(smooth_step(1e-4), 4e-8);  // level at the ends
}

}  // namespace
}  // namespace kinemark::motion::internal
