// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/sway.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

/// Whole turns of an ellipse.
SeriesMatrix ellipse(double a, double b, int n, int turns) {
  SeriesMatrix x(n, 2);
  for (int i = 0; i < n; ++i) {
    const double u = 2.0 * std::numbers::pi * turns * i / n;
    x(i, 0) = 0.3 + a * std::cos(u);
    x(i, 1) = b * std::sin(u);
  }
  return x;
}

TEST(Sway, ClosedFormsOfACircle) {
  const auto x = ellipse(0.01, 0.01, 2000, 5);
  EXPECT_NEAR(path_length(x), 5.0 * 2.0 * std::numbers::pi * 0.01, 2e-3 * 0.314);
  EXPECT_NEAR(mean_distance(x), 0.01, 1e-12);
  EXPECT_NEAR(mean_frequency(x, 10.0), 0.5, 1e-3);
}

TEST(Sway, TheAreaIsThatOfFisherAndCovariance) {
  // Variances a^2 / 2 and b^2 / 2 over whole turns; F(0.95; 2, 1998) = 3.0002 (Prieto et al. use 3.00).
  EXPECT_NEAR(ellipse_area(ellipse(0.02, 0.01, 2000, 4)), 2.0 * std::numbers::pi * 3.0002 * 0.5 * 0.02 * 0.01,
              1e-7);
  // F(0.95; 2, 10) = 4.1028 of tables.
  EXPECT_NEAR(ellipse_area(ellipse(1.0, 1.0, 12, 1)), 2.0 * std::numbers::pi * 4.1028 * 0.5, 1e-3);
  EXPECT_TRUE(std::isnan(ellipse_area(SeriesMatrix::Zero(3, 2))));
}

TEST(Sway, TheEllipseHolds95PercentOfANormalPath) {
  Random random(3, 1);
  SeriesMatrix x(20000, 2);
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 0) = random.gaussian(), x(i, 1) = 2.0 * random.gaussian();
  // Of independent normals the ellipse of Mahalanobis radius r has the area pi r^2 s1 s2.
  const double radius2 = ellipse_area(x) / (std::numbers::pi * 2.0);
  int inside = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    inside += x(i, 0) * x(i, 0) + 0.25 * x(i, 1) * x(i, 1) < radius2;
  EXPECT_NEAR(inside / 20000.0, 0.95, 0.006);
}

}  // namespace
}  // namespace kinemark::analysis
