// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/constructions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using Eigen::Vector3d;

Vector3d some(Random& random, double size) {
  return size * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
}

TEST(Chord, IsAtItsDistancePerpendicularInThePlaneAwayFromTheWand) {
  Random random(21, 1);
  for (int n = 0; n < 100; ++n) {
    const Vector3d marker = some(random, 0.1),
                   proximal = marker + Vector3d(0.02, 0.03, 0.4) + some(random, 0.02);
    const Vector3d wand = marker + Vector3d(0.01, 0.12, 0.2) + some(random, 0.02);
    const Vector3d c = chord(wand, marker, proximal, 0.058);
    EXPECT_NEAR((c - marker).norm(), 0.058, 1e-12);
    EXPECT_NEAR((c - marker).dot(c - proximal), 0.0, 1e-12);
    const Vector3d normal = (proximal - marker).cross(wand - marker).normalized();
    EXPECT_NEAR(normal.dot(c - marker), 0.0, 1e-12);
    const Vector3d e = (proximal - marker).normalized();
    EXPECT_LT((c - marker).dot(wand - marker - (wand - marker).dot(e) * e), 0.0);
  }
}

TEST(Chord, TurnsTheJointsAxisByTheAngleOfTheWand) {
  Random random(22, 1);
  for (int n = 0; n < 100; ++n) {
    const Vector3d marker = some(random, 0.1), proximal = marker + Vector3d(0.02, 0.03, 0.4);
    const Vector3d wand = marker + Vector3d(0.01, 0.12, 0.2) + some(random, 0.02);
    const double turn = random.uniform(-0.6, 0.6);
    const Vector3d c = chord(wand, marker, proximal, 0.058, turn);
    EXPECT_NEAR((c - marker).norm(), 0.058, 1e-12);
    EXPECT_NEAR((c - marker).dot(c - proximal), 0.0, 1e-12);
    EXPECT_NEAR(turn_about(proximal - c, marker - c, wand - c), turn, 1e-9);
  }
}

// Just inside and just outside of what a wand near the line of marker and proximal centre allows.
TEST(Chord, IsMissingWhereTheWandIsNearerThanItsOffsetAllows) {
  const Vector3d marker(0, 0, 0), proximal(0, 0, 0.4);
  const double d = 0.06, turn = 0.5, s = std::sqrt(1.0 - d * d / 0.16), t = std::tan(turn);
  const double least = d * 0.5 * t / std::sqrt(1.0 + s * s * t * t);  // half way up
  EXPECT_TRUE(chord({0, 1.001 * least, 0.2}, marker, proximal, d, turn).allFinite());
  EXPECT_TRUE(chord({0, 0.999 * least, 0.2}, marker, proximal, d, turn).hasNaN());
  EXPECT_TRUE(chord({0, 0.999 * least, 0.2}, marker, proximal, d).allFinite())
      << "without a turn it is there";
  EXPECT_TRUE(chord({0, 0.1, 0.2}, marker, proximal, d, 1.6).hasNaN()) << "beyond 90 deg";
}

TEST(Chord, HasNoCentreWhereGeometryHasNone) {
  const Vector3d marker(0, 0, 0), wand(0, 0.1, 0.2);
  EXPECT_TRUE(chord(wand, marker, {0, 0, 0.05}, 0.058).hasNaN());
  EXPECT_TRUE(chord({0, 0, 0.2}, marker, {0, 0, 0.4}, 0.058).hasNaN());
  EXPECT_TRUE(chord({0, std::nan(""), 0.2}, marker, {0, 0, 0.4}, 0.058).hasNaN());
}

TEST(Corner, IsWhereThreeRodsMeet) {
  Random random(23, 1);
  for (int n = 0; n < 100; ++n) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
            .normalized();
    const Vector3d at = some(random, 1.0);
    const auto rod = [&](int axis) -> Vector3d { return at + turn * (0.1 * Vector3d::Unit(axis)); };
    const Vector3d behind = at - turn * Vector3d(0.1, 0.1, 0.1);
    EXPECT_LT((corner(rod(0), rod(1), rod(2), behind) - at).norm(), 1e-12);
    EXPECT_LT((corner(rod(1), rod(0), rod(2), behind) - at).norm(), 1e-12);
    EXPECT_GT((corner(rod(0), rod(1), rod(2), rod(0) + rod(1) - at) - at).norm(), 0.05);
  }
  EXPECT_TRUE(corner({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}).hasNaN());
}

TEST(Corner, OfAnUnequalTriangleIsBelowItsCentroidByTheRootMeanSquareSide) {
  const Vector3d a(0.11, 0, 0), b(0, 0.1, 0), c(0, 0, 0.09), centroid = (a + b + c) / 3.0;
  const Vector3d found = corner(a, b, c, Vector3d::Zero());
  const double squares = (a - b).squaredNorm() + (b - c).squaredNorm() + (c - a).squaredNorm();
  EXPECT_NEAR((found - centroid).squaredNorm(), squares / 18.0, 1e-15);
  EXPECT_NEAR((found - centroid).dot(a - b), 0.0, 1e-15);
}

TEST(TurnAbout, CountsAgainstTheClock) {
  EXPECT_DOUBLE_EQ(turn_about(Vector3d::UnitZ(), {1, 0, 5}, {0, 2, -3}), std::acos(0.0));
  EXPECT_DOUBLE_EQ(turn_about(-Vector3d::UnitZ(), {1, 0, 5}, {0, 2, -3}), -std::acos(0.0));
  EXPECT_TRUE(std::isnan(turn_about(Vector3d::UnitZ(), {0, 0, 1}, {0, 2, 0})));
}

}  // namespace
}  // namespace kinemark::analysis
