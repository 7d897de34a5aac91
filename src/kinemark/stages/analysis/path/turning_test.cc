// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/turning.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

constexpr double kWhole = 2.0 * std::numbers::pi;

/// An ellipse from some phase on, tilted; a hundred samples a turn and a bit, so that turns end between
/// samples.
PathMatrix ellipse(double turns, double long_m, double short_m, double way = 1.0) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  const auto n = static_cast<Eigen::Index>(100.3 * turns) + 1;
  PathMatrix out(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double phase = 0.4 + way * kWhole * static_cast<double>(i) / 100.3;
    out.row(i) =
        (rotation * Eigen::Vector3d(0.5 * long_m * std::cos(phase), 0.5 * short_m * std::sin(phase), 0.1))
            .transpose();
  }
  return out;
}

TEST(Turning, CountsTurnsEitherWayAndSaysWhereTheLastEnds) {
  for (const double way : {1.0, -1.0})
    for (const double turns : {0.7, 1.3, 3.05, 20.4}) {
      const auto x = ellipse(turns, 0.4, 0.3, way);
      const auto found = turning_of(x);
      EXPECT_NEAR(found.turns, turns, 0.05);  // angles, not phases
      EXPECT_TRUE(found.one_way);
      EXPECT_TRUE(found.on_an_ellipse);
      if (turns < 1.0) {
        EXPECT_TRUE(std::isnan(found.whole_turns_end));
        EXPECT_TRUE(std::isnan(whole_turns_end(x, found)));
        continue;
      }
      EXPECT_NEAR(found.whole_turns_end, 100.3 * std::floor(turns), 0.01);
      EXPECT_NEAR(whole_turns_end(x, found), 100.3 * std::floor(turns), 0.01);
    }
}

TEST(Turning, ThereAndBackIsNoTurn) {
  PathMatrix x = ellipse(2.0, 0.4, 0.3);
  for (Eigen::Index i = 0; i < x.rows() / 2; ++i) x.row(x.rows() - 1 - i) = x.row(i);
  EXPECT_FALSE(turning_of(x).one_way);
}

TEST(Turning, ALineIsNoEllipse) {
  EXPECT_FALSE(turning_of(ellipse(1.5, 0.4, 0.02)).on_an_ellipse);
  EXPECT_TRUE(turning_of(ellipse(1.5, 0.4, 0.2)).on_an_ellipse);
  PathMatrix straight = PathMatrix::Zero(50, 3);
  straight.col(0).setLinSpaced(0.0, 1.0);
  EXPECT_FALSE(turning_of(straight).on_an_ellipse);
}

TEST(Turning, APathNearAnotherEndsItsTurnNearIt) {
  const auto x = ellipse(2.3, 0.4, 0.4);
  const auto settled = turning_of(x);
  Random random(5, 1);
  PathMatrix noisy = x;
  for (Eigen::Index i = 0; i < noisy.size(); ++i) noisy.data()[i] += 2e-4 * random.gaussian();
  EXPECT_NEAR(whole_turns_end(noisy, settled), 200.6, 0.1);
  // One that does not get there ends with its last sample.
  const PathMatrix shorter = x.topRows(200);
  EXPECT_EQ(whole_turns_end(shorter, settled), 199.0);
}

TEST(SpreadRatio, OfACircleIsOneOverWholeTurnsAlone) {
  for (const double turns : {1.2, 3.1, 7.7}) {
    const auto circle = ellipse(turns, 0.392, 0.392);
    EXPECT_NEAR(spread_ratio(circle, turning_of(circle).whole_turns_end), 1.0, 1e-5);
    EXPECT_GT(spread_ratio(circle, static_cast<double>(circle.rows() - 1)), 1.01);
  }
  const auto three = ellipse(3.1, 0.392, 0.392);
  EXPECT_NEAR(spread_ratio(three, static_cast<double>(three.rows() - 1)), 1.0273,
              1e-4);  // 310 of 100.3 samples a turn
}

TEST(WidthRatio, IsThatOfTheAxesHoweverOftenItGoesAround) {
  const auto in_plane = [](const PathMatrix& x) { return along_axes(x, principal_axes(x)); };
  for (const double turns : {1.0, 1.4, 5.2}) {
    EXPECT_NEAR(width_ratio(in_plane(ellipse(turns, 0.4, 0.4))), 1.0, 6e-4);  // a hundred points have corners
    EXPECT_NEAR(width_ratio(in_plane(ellipse(turns, 0.4, 0.3))), 4.0 / 3.0, 1e-3);
  }
  EXPECT_TRUE(std::isnan(width_ratio(PathMatrix::Zero(5, 3))));
}

}  // namespace
}  // namespace kinemark::analysis
