// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/rotation_between.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d direction(Random& random) { return {random.gaussian(), random.gaussian(), random.gaussian()}; }

TEST(RotationBetween, TurnsOneDirectionIntoTheOtherByTheAngleBetweenThem) {
  Random random(71, 0);
  for (int i = 0; i < 200; ++i) {
    const Vector3d from = direction(random), to = direction(random);
    const Quaterniond turn = rotation_between(from, to);
    // Rounding of 1 + cosine, as a part of it: directions that are nearly opposite lose as much.
    const double rounding = 1e-15 / (1.0 + from.normalized().dot(to.normalized()));
    EXPECT_NEAR(turn.norm(), 1.0, rounding);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 4.0 * rounding);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(2.0 * std::acos(turn.w()), angle, 1e-7);
  }
}

TEST(RotationBetween, IsNoTurnBetweenEqualDirections) {
  EXPECT_TRUE(rotation_between({0.0, 2.0, 0.0}, {0.0, 5.0, 0.0}).isApprox(Quaterniond::Identity(), 1e-15));
}

TEST(RotationBetween, IsHalfATurnAcrossOppositeDirections) {
  for (const Vector3d& from :
       {Vector3d(0, 3, 0), Vector3d(1, 0, 0), Vector3d(0, 0, -2), Vector3d(1, -2, 3)}) {
    const Quaterniond turn = rotation_between(from, -0.5 * from);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-15);
    EXPECT_LT((turn * from + from).norm(), 1e-14 * from.norm());
  }
}

TEST(RotationBetween, FindsTheAxisOfDirectionsThatAreNearlyOpposite) {
  for (const double off_rad : {1e-2, 1e-3, 1e-5, 3e-6}) {
    const double rounding = 1e-15 / (off_rad * off_rad);  // of 1 + cosine, as a part of it
    const double angle = std::numbers::pi - off_rad;
    const Vector3d to(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_LT((rotation_between(Vector3d::UnitX(), to) * Vector3d::UnitX() - to).norm(), rounding);
  }
}

}  // namespace
}  // namespace kinemark::math
