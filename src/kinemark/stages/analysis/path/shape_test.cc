// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using testing::kTurn;

const Eigen::Matrix3d kTilt = (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) *
                               Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix();
const Eigen::Vector3d kPlace(1.0, -2.0, 0.5);

// x(t), y(t), z(t) in a tilted frame, somewhere.
template <class Own>
PathSamples tilted(std::int64_t n, double rate_hz, const Own& own) {
  return testing::path_of(n, rate_hz, [&](double t) -> Eigen::Vector3d { return kPlace + kTilt * own(t); });
}

Eigen::Vector3d box_of(const PathMatrix& x) { return smallest_box(x, principal_axes(x)); }

PathSamples helix() {
  return tilted(1208, 400.0, [](double t) {
    return Eigen::Vector3d(0.3 * std::cos(4 * t), 0.3 * std::sin(4 * t), 0.2 * t);
  });
}

TEST(Derivatives, AreExactForPolynomials) {
  const auto cubic = [](double t) { return Eigen::Vector3d(t * t * t, 2.0 * t * t, -t); };
  const auto path = testing::path_of(40, 20.0, cubic);
  for (std::int64_t i = 0; i < path.count(); ++i) {
    const double t = static_cast<double>(i + kDerivativeMargin) / 20.0;
    EXPECT_NEAR((path.v.row(i) - Eigen::RowVector3d(3 * t * t, 4 * t, -1)).norm(), 0.0, 1e-11);
    EXPECT_NEAR((path.a.row(i) - Eigen::RowVector3d(6 * t, 4, 0)).norm(), 0.0, 1e-10);
    EXPECT_NEAR((path.j.row(i) - Eigen::RowVector3d(6, 0, 0)).norm(), 0.0, 1e-8);
  }
}

TEST(PathLength, OfAHelixIsItsArc) {
  // Chords of a finely sampled helix: shorter by (0.01 rad)^2 / 24.
  const auto path = helix();
  const double duration = static_cast<double>(path.count() - 1) / 400.0;
  EXPECT_NEAR(path_length(path.x), duration * std::hypot(1.2, 0.2), 1e-5 * duration);
  EXPECT_NEAR(straightness(testing::sampled(9, 1.0, [](double t) { return Eigen::Vector3d(t, 2 * t, 0); })),
              1.0, 1e-15);
  EXPECT_EQ(path_length(SeriesMatrix::Zero(1, 3)), 0.0);
  EXPECT_TRUE(std::isnan(straightness(SeriesMatrix::Zero(5, 3))));
}

TEST(Plane, DistanceAndAxesOfATiltedRectangleOfPoints) {
  // Coordinates of +-a, +-b, +-c, each sign with each: variances a^2, b^2, c^2.
  SeriesMatrix x(8, 3);
  for (int k = 0; k < 8; ++k)
    x.row(k) =
        (kPlace + kTilt * Eigen::Vector3d(k & 1 ? 0.3 : -0.3, k & 2 ? 0.1 : -0.1, k & 4 ? 0.002 : -0.002))
            .transpose();
  const auto axes = principal_axes(x);
  EXPECT_NEAR(std::sqrt(axes.variance[2]), 0.002, 1e-12);
  EXPECT_NEAR(std::sqrt(axes.variance[0] / axes.variance[1]), 3.0, 1e-9);
  EXPECT_NEAR(std::abs(axes.axes.col(2).dot(kTilt.col(2))), 1.0, 1e-12);
  EXPECT_NEAR(axes.axes.determinant(), 1.0, 1e-12);
  // A flat path has no thickness, not that of the rounding of its length.
  x.col(2).setZero();
  EXPECT_LT(std::sqrt(principal_axes(x).variance[2]), 1e-15);
}

TEST(Circle, DiameterOfAnArcAndOfTheWholeInATiltedPlane) {
  for (const double share : {0.2, 1.0}) {
    const auto path = tilted(200, 192.0, [share](double t) {
      return Eigen::Vector3d(0.17 * std::cos(kTurn * share * t), 0.17 * std::sin(kTurn * share * t), 0.0);
    });
    EXPECT_NEAR(circle_diameter(along_axes(path.x, principal_axes(path.x))), 0.34, 1e-9) << share;
  }
  EXPECT_TRUE(std::isnan(circle_diameter(SeriesMatrix::Zero(10, 3))));
}

TEST(Circle, OfScatteredPointsIsThatOfLeastSquaredDistances) {
  // At the minimum a wider and a narrower circle are worse by the same; many points, of which a part goes
  // first.
  Random random(5, 0);
  SeriesMatrix x(5000, 2);
  for (std::int64_t i = 0; i < x.rows(); ++i) {
    const double angle = kTurn * random.uniform(), radius = 0.2 + 0.03 * random.gaussian();
    x.row(i) = Eigen::RowVector2d(radius * std::cos(angle), radius * std::sin(angle));
  }
  const double diameter = circle_diameter(x);
  // Its radius is the mean distance from its centre, which lies near 0.
  EXPECT_NEAR(diameter, 2.0 * x.rowwise().norm().mean(), 2e-5);
}

TEST(Ellipse, AxesOfATiltedOneAndNoneOfALine) {
  const auto path = tilted(150, 100.0, [](double t) {
    return Eigen::Vector3d(0.2 * std::cos(kTurn * t), 0.05 * std::sin(kTurn * t), 0);
  });
  const auto axes = ellipse_axes(along_axes(path.x, principal_axes(path.x)));
  EXPECT_NEAR(axes.major, 0.4, 1e-9);
  EXPECT_NEAR(axes.minor, 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(ellipse_axes(SeriesMatrix::Zero(9, 3)).major));
}

TEST(Diameters, OfAWheelAreItsDiameter) {
  // 40 samples a turn: each has one right across.
  const auto path = tilted(168, 40.0, [](double t) {
    return Eigen::Vector3d(0.15 * std::cos(kTurn * t), 0.15 * std::sin(kTurn * t), 0);
  });
  const auto found = diameters(path.x);
  EXPECT_NEAR(found.median_farthest, 0.3, 1e-9);
  EXPECT_NEAR(found.largest, 0.3, 1e-9);
}

TEST(SmallestBox, OfTheCornersOfATiltedBox) {
  SeriesMatrix x(9, 3);
  for (int k = 0; k < 8; ++k)
    x.row(k) = (kPlace + kTilt * Eigen::Vector3d(k & 1 ? 0.3 : 0.0, k & 2 ? 0.2 : 0.0, k & 4 ? 0.05 : 0.0))
                   .transpose();
  x.row(8) = (kPlace + kTilt * Eigen::Vector3d(0.29, 0.01, 0.01)).transpose();  // turns the principal axes
  const auto sides = box_of(x);
  EXPECT_NEAR(sides[0], 0.3, 1e-9);
  EXPECT_NEAR(sides[1], 0.2, 1e-9);
  EXPECT_NEAR(sides[2], 0.05, 1e-9);
}

TEST(SmallestBox, OfAFlatPathIsItsSmallestRectangle) {
  // A right triangle: the rectangle of its legs, which no principal axis follows.
  SeriesMatrix x(3, 3);
  x.row(0) = kPlace.transpose();
  x.row(1) = (kPlace + kTilt * Eigen::Vector3d(0.4, 0, 0)).transpose();
  x.row(2) = (kPlace + kTilt * Eigen::Vector3d(0, 0.3, 0)).transpose();
  const auto sides = box_of(x);
  EXPECT_NEAR(sides[0] * sides[1], 0.12, 1e-9);
  EXPECT_NEAR(sides[2], 0.0, 1e-9);
}

TEST(SmallestBox, OfManySamplesIsThatOfTheirCorners) {
  // What lies inside is left out before the sides are turned; the corners alone have the same box.
  Random random(6, 0);
  const std::int64_t n = 40000;
  SeriesMatrix x(n, 3);
  for (std::int64_t i = 0; i < n; ++i) {
    Eigen::Vector3d p(random.uniform(), random.uniform(), random.uniform());
    if (i < 8) p = Eigen::Vector3d(i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0);
    x.row(i) = (kPlace + kTilt * p.cwiseProduct(Eigen::Vector3d(0.5, 0.3, 0.1))).transpose();
  }
  EXPECT_LT((box_of(x) - Eigen::Vector3d(0.5, 0.3, 0.1)).norm(), 1e-9);
  // Of a flat one nothing lies inside.
  for (std::int64_t i = 0; i < n; ++i)
    x.row(i) = Eigen::RowVector3d(0.4 * std::cos(static_cast<double>(i)),
                                  0.4 * std::sin(static_cast<double>(i)), 0.0);
  const auto flat = box_of(x);
  EXPECT_NEAR(flat[0], 0.8, 1e-6);
  EXPECT_NEAR(flat[2], 0.0, 1e-12);
}

TEST(SmallestBox, OfAPathNearAnotherIsTheSameWithWhatIsKnownOfThat) {
  Random random(8, 0);
  for (const std::int64_t n : {100, 1500, 6000})
    for (const double noise : {1e-4, 0.01, 0.2}) {
      PathMatrix x(n, 3);
      for (std::int64_t i = 0; i < n; ++i) {
        const double t = 0.01 * static_cast<double>(i);
        x.row(i) << 0.3 * std::sin(t) + 0.1 * std::cos(7.1 * t), 0.2 * std::cos(0.9 * t),
            0.05 * std::sin(3.3 * t);
      }
      PathMatrix other = x;
      for (double& value : other.reshaped()) value += noise * random.gaussian();
      EXPECT_LT((deviations(x, other) - (x - other).rowwise().norm()).norm(), 1e-12);
      const auto axes = principal_axes(other);
      const auto alone = smallest_box(other, axes),
                 with_help = smallest_box(other, axes, outer_samples(x), x);
      EXPECT_LT((alone - with_help).norm(), 1e-12 * alone.norm()) << n << " " << noise;
    }
}

TEST(OuterSamples, NearestToTheHullComeFirst) {
  const std::int64_t n = 5000;
  Random random(2, 0);
  PathMatrix x(n, 3);
  for (double& value : x.reshaped()) value = random.uniform(-1.0, 1.0);
  for (int k = 0; k < 8; ++k) x.row(100 * k) << (k & 1 ? 1 : -1), (k & 2 ? 1 : -1), (k & 4 ? 1 : -1);
  const auto outer = outer_samples(x);
  ASSERT_EQ(outer.order.size(), static_cast<std::size_t>(n));
  ASSERT_EQ(outer.depth.size(), outer.order.size());
  // The hull is a cube: the depth of a point is its distance from the nearest side.
  for (std::size_t i = 0; i < outer.order.size(); ++i)
    ASSERT_NEAR(outer.depth[i], 1.0 - x.row(outer.order[i]).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(outer.depth));
}

TEST(SmallestBox, IsNeverLargerThanThatOfThePrincipalAxes) {
  Random random(4, 0);
  for (int set = 0; set < 50; ++set) {
    SeriesMatrix x(60, 3);
    for (double& value : x.reshaped()) value = random.gaussian();
    const SeriesMatrix along = along_axes(x, principal_axes(x));
    const double volume = (along.colwise().maxCoeff() - along.colwise().minCoeff()).prod();
    const auto sides = box_of(x);
    EXPECT_LE(sides.prod(), volume * (1.0 + 1e-9));
    EXPECT_GE(sides[0], sides[1]);
    EXPECT_GE(sides[1], sides[2]);
  }
}

TEST(Curvature, AndTorsionOfAHelixAreThoseOfItsFormula) {
  // r / (r^2 + c^2), c / (r^2 + c^2) with pitch c = speed along the axis over turning speed.
  const double r = 0.3, c = 0.2 / 4.0;
  EXPECT_NEAR(median_curvature(curvature_terms_of(helix())), r / (r * r + c * c), 1e-9);
  EXPECT_NEAR(median_torsion(curvature_terms_of(helix())), c / (r * r + c * c), 1e-7);
}

TEST(PowerLaw, ExponentOfAHarmonicEllipseIsAThird) {
  const auto path = tilted(
      808, 400.0, [](double t) { return Eigen::Vector3d(0.2 * std::cos(5 * t), 0.07 * std::sin(5 * t), 0); });
  EXPECT_NEAR(power_law_exponent(curvature_terms_of(path)), 1.0 / 3.0, 1e-9);
}

}  // namespace
}  // namespace kinemark::analysis
