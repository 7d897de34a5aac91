// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_measures.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"

namespace kinemark::studies {
namespace {

/// An ellipse with these axes, tilted and moved.
Eigen::Matrix3Xd ellipse(double long_m, double short_m, int n) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::Matrix3Xd out(3, n);
  for (int i = 0; i < n; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / n;
    out.col(i) =
        rotation * Eigen::Vector3d(0.5 * long_m * std::cos(phase), 0.5 * short_m * std::sin(phase), 0.0) +
        Eigen::Vector3d(0.3, -1.0, 2.0);
  }
  return out;
}

TEST(WheelMeasures, PerfectCircleHasNoError) {
  const auto m = measure_wheel(ellipse(0.392, 0.392, 220), 0.392);
  EXPECT_NEAR(m.median_error_m, 0.0, 1e-12);
  EXPECT_NEAR(m.sd_m, 0.0, 1e-12);
  EXPECT_NEAR(m.max_error_m, 0.0, 1e-12);
  EXPECT_NEAR(m.plane_sd_m, 0.0, 1e-12);
  EXPECT_NEAR(m.circle_error_m, 0.0, 1e-12);
  EXPECT_NEAR(m.width_ratio, 1.0, 2e-4);  // 220 points have corners
  EXPECT_NEAR(m.ellipse_ratio, 1.0, 1e-6);
}

TEST(WheelMeasures, EllipseShowsInTheRatio) {
  const auto m = measure_wheel(ellipse(0.40, 0.38, 360), 0.392);
  EXPECT_NEAR(m.width_ratio, 0.40 / 0.38, 1e-4);
  EXPECT_NEAR(m.ellipse_ratio, 0.40 / 0.38, 1e-6);
  EXPECT_NEAR(m.spread_of_all, 0.40 / 0.38, 1e-4);
}

TEST(WheelMeasures, OnePointOffTheWheelIsTheLargestError) {
  auto points = ellipse(0.392, 0.392, 220);
  const Eigen::Vector3d centre = points.rowwise().mean();
  points.col(17) += 0.010 * (points.col(17) - centre).normalized();
  const auto m = measure_wheel(points, 0.392);
  EXPECT_NEAR(m.max_error_m, 0.010, 1e-4);
  EXPECT_NEAR(m.median_error_m, 0.0, 1e-4);
  EXPECT_NEAR(m.width_ratio, 0.402 / 0.392, 1e-3);
}

TEST(WheelMeasures, ScatterAcrossThePlane) {
  auto points = ellipse(0.392, 0.392, 200);
  const Eigen::Vector3d across = best_fit_plane(points).axes.col(2);
  for (int i = 0; i < 200; ++i) points.col(i) += (i % 2 == 0 ? 1e-3 : -1e-3) * across;
  EXPECT_NEAR(measure_wheel(points, 0.392).plane_sd_m, 1e-3, 2e-5);
}

TEST(WheelMeasures, NeedsFourPoints) {
  EXPECT_THROW(static_cast<void>(measure_wheel(Eigen::Matrix3Xd::Zero(3, 3), 1.0)), ContractError);
}

}  // namespace
}  // namespace kinemark::studies
