// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/sign_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using ::testing::HasSubstr;

/// Round a circle of 0.2 m with the angle t^2: speed 0.4 t, tangential acceleration 0.4, centripetal 0.8 t^2.
struct Circle {
  Matrix3Xd x{3, 120}, v{3, 120}, a{3, 120};
  Circle() {
    for (int f = 0; f < 120; ++f) {
      const double t = 0.01 * f, angle = t * t, r = 0.2;
      const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0),
          along(-std::sin(angle), std::cos(angle), 0.0);
      x.col(f) = r * out;
      v.col(f) = 2.0 * r * t * along;
      a.col(f) = 2.0 * r * along - 4.0 * r * t * t * out;
    }
  }
};

TEST(TangentialMotion, IsTheRateOfTheSpeedNotTheLengthOfTheAcceleration) {
  const Circle circle;
  const auto motion = tangential_motion(circle.v, circle.a);
  EXPECT_EQ(motion.acceleration[0], 0.0) << "at rest";
  for (int f = 1; f < 120; ++f) {
    EXPECT_NEAR(motion.speed[f], 0.004 * f, 1e-12);
    EXPECT_NEAR(motion.acceleration[f], 0.4, 1e-12);
  }
  EXPECT_GT(circle.a.col(119).norm(), 1.0);
}

TEST(SignFigure, HoldsDrawingPathsAndCurves) {
  const Circle circle;
  ArmOutcome arm;
  for (const char* name : {"shoulder", "elbow", "wrist", "hand"}) {
    arm.leds.push_back({.name = name});
    AlignedPath path;
    path.position =
        circle.x.colwise() + Eigen::Vector3d(0.1 * static_cast<double>(arm.leds.size()), 0.0, 0.0);
    path.velocity = circle.v;
    path.acceleration = circle.a;
    arm.our_paths.push_back(path);
    arm.classic_paths.push_back(path.position);
  }
  const auto figure = sign_figure(arm);
  EXPECT_EQ(figure.title(), "Poizner 1986, figure 6");
  const auto svg = report::figure_svg(figure.figure);
  for (const char* part : {">A<", ">B<", ">C<", "tangential velocity, m/s", "1986 method"})
    EXPECT_THAT(svg, HasSubstr(part));
  const auto& drawn = figure.curves.back();
  EXPECT_EQ(drawn.name, "tangential acceleration");
  EXPECT_NEAR(drawn.points(60, 0), 0.6, 1e-12);
  EXPECT_NEAR(drawn.points(60, 1), 0.4, 1e-12);
}

}  // namespace
}  // namespace kinemark::studies
