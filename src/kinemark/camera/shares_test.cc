// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/shares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

using data::DetectorKind;
using std::numbers::pi;

/// Share of the +x edge by the Fourier series of the Dirichlet problem: an independent derivation.
double share_by_series(double x, double y) {
  double sum = 0.0;
  for (int n = 1; n < 400; n += 2) {
    // sinh(a) / sinh(b) without overflow
    const double a = n * pi * (1.0 + x) / 2.0, b = n * pi;
    sum += 4.0 / (n * pi) * std::sin(n * pi * (1.0 + y) / 2.0) * std::exp(a - b) *
           (1.0 - std::exp(-2.0 * a)) / (1.0 - std::exp(-2.0 * b));
  }
  return sum;
}

TEST(TetraLateral, EqualsTheFourierSeries) {
  Random random(1, 1);
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(-0.9, 0.9);
    const double y = random.uniform(-0.9, 0.9);
    const auto share = tetra_lateral_shares(x, y).share;
    EXPECT_NEAR(share[0], share_by_series(x, y), 3e-15);
    EXPECT_NEAR(share[1], share_by_series(-x, y), 3e-15);
    EXPECT_NEAR(share[2], share_by_series(y, x), 3e-15);
    EXPECT_NEAR(share[3], share_by_series(-y, x), 3e-15);
  }
}

TEST(TetraLateral, SumsToOneUpToTheEdges) {
  for (const double x : {-0.999, -0.5, 0.0, 0.3, 0.999})
    for (const double y : {-0.999, -0.7, 0.0, 0.999}) {
      const auto s = tetra_lateral_shares(x, y);
      EXPECT_NEAR(s.share.sum(), 1.0, 1e-14);
      EXPECT_GE(s.share.minCoeff(), 0.0);
      EXPECT_LT(s.d_spot.colwise().sum().cwiseAbs().maxCoeff(), 1e-10);
    }
}

TEST(TetraLateral, SlopeAtTheCentreAndRatiosAlongAnAxis) {
  const auto ratio = [](const Eigen::Vector4d& h) { return (h[0] - h[1]) / (h[0] + h[1]); };
  const auto centre = tetra_lateral_shares(0, 0);
  // 2 sqrt2 K(1/2) / pi, from the conformal map's derivative
  EXPECT_NEAR((centre.d_spot(0, 0) - centre.d_spot(1, 0)) / 0.5,
              2.0 * std::sqrt(2.0) * 1.8540746773013719 / pi, 1e-14);
  EXPECT_NEAR(ratio(tetra_lateral_shares(0.5, 0).share), 0.700, 5e-4);
  EXPECT_NEAR(ratio(tetra_lateral_shares(0.9, 0).share), 0.962, 5e-4);
}

TEST(TetraLateral, BlurChangesNothing) {
  // Shares are harmonic: their mean over a circle is their value at its centre.
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  constexpr int kPoints = 64;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * pi * i / kPoints;
    mean += tetra_lateral_shares(0.4 + 0.2 * std::cos(angle), -0.3 + 0.2 * std::sin(angle)).share / kPoints;
  }
  EXPECT_LT((mean - tetra_lateral_shares(0.4, -0.3).share).norm(), 1e-14);
}

TEST(OtherSheets, RatiosAreLinear) {
  for (const double x : {-0.8, 0.1, 0.6})
    for (const double y : {-0.4, 0.0, 0.9}) {
      const auto duo = duo_lateral_shares(x, y).share;
      EXPECT_NEAR((duo[0] - duo[1]) / (duo[0] + duo[1]), x, 1e-15);
      EXPECT_NEAR((duo[2] - duo[3]) / (duo[2] + duo[3]), y, 1e-15);
      const auto pin = pin_cushion_shares(x, y).share;
      EXPECT_NEAR(((pin[0] + pin[3]) - (pin[1] + pin[2])) / pin.sum(), x, 1e-15);
      EXPECT_NEAR(((pin[0] + pin[2]) - (pin[1] + pin[3])) / pin.sum(), y, 1e-15);
    }
}

TEST(Generic, HoldsPolynomialsAndTheRestOfOne) {
  // +x: 0.1 + 0.2 x, -x: 0.3 y, +y: 0.4
  const std::vector<double> c{0.1, 0.2, 0.0, 0.0, 0.0, 0.3, 0.4, 0.0, 0.0};
  const auto s = generic_shares(c, 1, 0.5, -0.2);
  EXPECT_LT((s.share - Eigen::Vector4d(0.2, -0.06, 0.4, 0.46)).norm(), 1e-15);
  EXPECT_THROW((void)generic_shares(c, 2, 0.0, 0.0), std::logic_error);
}

TEST(Shares, DerivativesMatchDifferencesForEveryKind) {
  Random random(2, 1);
  for (const auto kind : {DetectorKind::tetra_lateral, DetectorKind::duo_lateral, DetectorKind::pin_cushion,
                          DetectorKind::generic}) {
    const auto detector = imperfect_camera(data::CameraKind::lateral_effect, kind, 5).detector;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d at{random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9)};
      const auto slow = differences(
          [&detector](const Eigen::VectorXd& p) { return shares(detector, p[0], p[1]).share; }, at, 5e-4);
      EXPECT_LT((shares(detector, at.x(), at.y()).d_spot - slow).norm(), 1e-8) << to_string(kind);
    }
  }
}

TEST(Shares, ASpotBeyondTheEdgeCountsAsLyingThere) {
  data::Detector detector;
  const auto out = shares(detector, 1.7, 0.2);
  EXPECT_EQ(out.share, shares(detector, 0.985, 0.2).share);
  EXPECT_EQ(out.d_spot.col(0).norm(), 0.0);
  EXPECT_GT(out.d_spot.col(1).norm(), 0.0);
  EXPECT_TRUE(shares(detector, -1e300, 1e300).share.allFinite());
  detector.edge = 1.0;
  EXPECT_TRUE(shares(detector, 1.0, 1.0).share.allFinite());
}

}  // namespace
}  // namespace kinemark::camera
