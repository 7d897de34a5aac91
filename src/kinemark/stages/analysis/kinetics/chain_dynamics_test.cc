// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/chain_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;

constexpr double kRate_hz = 100.0;
constexpr std::int64_t kFrames = 60;
const Vector3d kGravity(0.0, 0.0, -9.81);

double time_of(std::int64_t f) { return static_cast<double>(f) / kRate_hz; }

Matrix3d about(const Vector3d& axis, double angle) { return AngleAxisd(angle, axis).toRotationMatrix(); }

BodyTrack body_at(double mass, const Vector3d& gyration) {
  BodyTrack out{.mass = mass, .gyration = gyration, .centre = MatrixX3d::Zero(kFrames, 3), .axes = {}};
  out.axes.assign(at(kFrames), Matrix3d::Identity());
  return out;
}

TEST(ChainDynamics, BodyAtRestWeighsOnWhatHoldsIt) {
  auto body = body_at(2.0, Vector3d(0.1, 0.1, 0.1));
  body.centre.rowwise() = Eigen::RowVector3d(0.3, 0.0, 1.0);
  const auto wrench = inertial_wrench(body, kGravity, kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f) {
    EXPECT_NEAR((Vector3d(wrench.force.row(f)) - Vector3d(0.0, 0.0, -19.62)).norm(), 0.0, 1e-10);
    // About a point at the same height, 0.3 m behind: the weight turns forwards.
    EXPECT_NEAR(wrench.moment_about(Vector3d(0.0, 0.0, 1.0), f).y(), 0.3 * 19.62, 1e-10);
  }
  for (const std::int64_t f : {0L, 3L, kFrames - 4, kFrames - 1})
    EXPECT_TRUE(std::isnan(wrench.force(f, 0))) << f;
}

TEST(ChainDynamics, FreeFallBearsNothing) {
  auto body = body_at(3.0, Vector3d(0.2, 0.1, 0.05));
  for (std::int64_t f = 0; f < kFrames; ++f)
    body.centre.row(f) = Vector3d(1.5, -0.5, 2.0) * time_of(f) + 0.5 * kGravity * time_of(f) * time_of(f);
  const auto wrench = inertial_wrench(body, kGravity, kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f) EXPECT_NEAR(wrench.force.row(f).norm(), 0.0, 1e-9);
}

// A rod that swings about its end: M = - m g l / 2 sin - m l^2 / 3 angle'', in closed form.
TEST(ChainDynamics, PendulumHasTheMomentOfItsEquation) {
  constexpr double kMass = 1.2, kLength = 0.5;
  const double radius = kLength / std::sqrt(12.0);
  auto rod = body_at(kMass, Vector3d(radius, radius, 0.0));
  const auto angle = [](double t) { return 0.7 * std::sin(5.0 * t); };
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const Matrix3d r = about(Vector3d::UnitY(), angle(time_of(f)));
    rod.axes[at(f)] = r;
    rod.centre.row(f) = r * Vector3d(0.0, 0.0, -0.5 * kLength);
  }
  const auto wrench = inertial_wrench(rod, kGravity, kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f) {
    const double a = angle(time_of(f)), second = -25.0 * a;
    const double expected =
        -kMass * 9.81 * 0.5 * kLength * std::sin(a) - kMass * kLength * kLength / 3.0 * second;
    EXPECT_NEAR(wrench.moment_about(Vector3d::Zero(), f).y(), expected, 1e-7) << f;
    EXPECT_NEAR(wrench.moment_about(Vector3d::Zero(), f).x(), 0.0, 1e-9);
  }
}

// A torque-free top precesses about its momentum: closed form of Euler's equations for two equal moments.
TEST(ChainDynamics, FreeTopNeedsNoMoment) {
  auto top = body_at(2.0, Vector3d(0.1, 0.1, 0.2));
  const double transverse = 0.02, axial = 0.08, spin = 3.0, tilt = 0.4;
  const double precession = axial * spin / (transverse * std::cos(tilt));
  const double own = spin - precession * std::cos(tilt);
  for (std::int64_t f = 0; f < kFrames; ++f)
    top.axes[at(f)] = about(Vector3d::UnitZ(), precession * time_of(f)) * about(Vector3d::UnitX(), tilt) *
                      about(Vector3d::UnitZ(), own * time_of(f));
  const auto wrench = inertial_wrench(top, Vector3d::Zero(), kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f)
    EXPECT_NEAR(wrench.moment.row(f).norm(), 0.0, 1e-5 * transverse * precession * precession) << f;
}

TEST(ChainDynamics, AngularVelocityIsThatOfTheAxes) {
  std::vector<Matrix3d> axes;
  const Vector3d axis = Vector3d(1.0, 2.0, -1.0).normalized();
  for (std::int64_t f = 0; f < kFrames; ++f) axes.push_back(about(axis, 0.5 * std::sin(8.0 * time_of(f))));
  const auto w = angular_velocity(axes, kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f)
    EXPECT_NEAR((Vector3d(w.row(f)) - 4.0 * std::cos(8.0 * time_of(f)) * axis).norm(), 0.0, 1e-6);
  EXPECT_TRUE(std::isnan(w(2, 0)));
}

// Twice the difference over two frames to either side multiplies what swings at w by (sin(2 w dt) / (2 dt
// w))^2.
TEST(ChainDynamics, AngularSpanSmoothsAsItsDifferencesDo) {
  constexpr double kSwing = 20.0;
  auto rod = body_at(1.0, Vector3d(0.2, 0.2, 0.0));
  for (std::int64_t f = 0; f < kFrames; ++f)
    rod.axes[at(f)] = about(Vector3d::UnitY(), 1e-3 * std::sin(kSwing * time_of(f)));
  const auto wrench = inertial_wrench(rod, Vector3d::Zero(), kRate_hz, 2);
  const double lost = std::sin(2.0 * kSwing / kRate_hz) / (2.0 * kSwing / kRate_hz);
  for (std::int64_t f = 4; f < kFrames - 4; ++f) {
    const double second = -kSwing * kSwing * 1e-3 * std::sin(kSwing * time_of(f));
    EXPECT_NEAR(wrench.moment(f, 1), -0.04 * second * lost * lost, 1e-7) << f;
  }
  EXPECT_TRUE(std::isnan(wrench.moment(3, 1)));
  EXPECT_LT(lost * lost, 0.96) << "or the test would not tell both apart";
}

TEST(ChainDynamics, MissingFrameIsMissingInItsNeighbourhoodOnly) {
  auto body = body_at(2.0, Vector3d(0.1, 0.1, 0.1));
  body.centre.row(30).setConstant(kNaN);
  const auto wrench = inertial_wrench(body, kGravity, kRate_hz);
  EXPECT_TRUE(std::isnan(wrench.force(26, 0)));
  EXPECT_TRUE(std::isnan(wrench.force(34, 0)));
  EXPECT_TRUE(std::isfinite(wrench.force(25, 0)));
  EXPECT_TRUE(std::isfinite(wrench.force(35, 0)));
}

}  // namespace
}  // namespace kinemark::analysis
