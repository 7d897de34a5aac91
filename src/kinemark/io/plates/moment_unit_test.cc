// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/plates/internal/moment_unit.h"

#include <gtest/gtest.h>

#include <vector>

namespace kinemark::io::internal {
namespace {

using Eigen::Vector2d;

const Vector2d kHalf(0.25, 0.3);

/// A foot that rolls from `from` to `to`, its points `scale` times as far from the middle, `load` N.
std::vector<Vector6> rolling(const Vector2d& from, const Vector2d& to, double scale, double load = 700.0) {
  std::vector<Vector6> out;
  for (int f = 0; f < 20; ++f) {
    const Vector2d point = scale * (from + (to - from) * (f / 19.0));
    Vector6 w = Vector6::Zero();
    w[2] = -load;
    w[3] = point.y() * w[2];
    w[4] = -point.x() * w[2];
    out.push_back(w);
  }
  return out;
}

const Vector2d kHeel(-0.05, -0.12), kToe(-0.03, 0.14);

TEST(MomentUnit, IsTheOneThatPutsTheForceOnThePlate) {
  const auto right = rolling(kHeel, kToe, 1.0), far = rolling(kHeel, kToe, 1e3),
             near = rolling(kHeel, kToe, 1e-3);
  EXPECT_TRUE(is_a_thousandth(far, right, true, kHalf));
  EXPECT_TRUE(is_a_thousandth(right, near, false, kHalf));
}

TEST(MomentUnit, OfAPlateThatIsFineStays) {
  const auto right = rolling(kHeel, kToe, 1.0), far = rolling(kHeel, kToe, 1e3),
             near = rolling(kHeel, kToe, 1e-3);
  EXPECT_FALSE(is_a_thousandth(right, near, true, kHalf));
  EXPECT_FALSE(is_a_thousandth(far, right, false, kHalf));
}

TEST(MomentUnit, IsNotBlamedForCornersThatLieElsewhere) {
  // Half a metre off the plate: a thousandth of it would lie on every plate.
  const Vector2d off(0.9, 0.4);
  EXPECT_FALSE(is_a_thousandth(rolling(off, off, 1.0), rolling(off, off, 1e-3), true, kHalf));
}

TEST(MomentUnit, OfAnotherFactorIsNoUnit) {
  // Thirty times too large: a thousandth of it would have the foot stand in the middle.
  EXPECT_FALSE(is_a_thousandth(rolling(kHeel, kToe, 40.0), rolling(kHeel, kToe, 0.04), true, kHalf));
}

TEST(MomentUnit, OfWeightsAtTheMiddleAndOfMomentsThatWereNotRecordedStays) {
  const Vector2d middle(4e-6, -3e-6);  // m, of noise
  EXPECT_FALSE(is_a_thousandth(rolling(middle, middle, 1e3), rolling(middle, middle, 1.0), false, kHalf));
  EXPECT_FALSE(is_a_thousandth(rolling(Vector2d::Zero(), Vector2d::Zero(), 1.0),
                               rolling(Vector2d::Zero(), Vector2d::Zero(), 1.0), false, kHalf));
}

TEST(MomentUnit, OfAPlateThatNobodyLoadsStays) {
  const auto far = rolling(kHeel, kToe, 1e3, 40.0), right = rolling(kHeel, kToe, 1.0, 40.0);
  EXPECT_FALSE(is_a_thousandth(far, right, true, kHalf));
  const auto steps = rolling(kHeel, kToe, 1e3), on = rolling(kHeel, kToe, 1.0);
  EXPECT_FALSE(is_a_thousandth(std::span(steps).first(4), std::span(on).first(4), true, kHalf));
  EXPECT_TRUE(is_a_thousandth(std::span(steps).first(5), std::span(on).first(5), true, kHalf));
}

TEST(MomentUnit, ThePlateReachesALittleBeyondItsCorners) {
  EXPECT_TRUE(is_on_plate({0.25, -0.3}, kHalf));
  EXPECT_TRUE(is_on_plate({0.31, 0.0}, kHalf));
  EXPECT_FALSE(is_on_plate({0.33, 0.0}, kHalf));
  EXPECT_FALSE(is_on_plate({0.0, -0.4}, kHalf));
}

}  // namespace
}  // namespace kinemark::io::internal
