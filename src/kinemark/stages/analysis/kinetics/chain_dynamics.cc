// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/chain_dynamics.h"

#include <Eigen/Geometry>
#include <array>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;

// Fornberg 1988, eighth order: of neighbours 1 to 4, and of the sample itself.
constexpr std::array<double, 4> kFirst{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
constexpr std::array<double, 4> kSecond{8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
constexpr double kSecondOfItself = -205.0 / 72;

Vector3d axial(const Matrix3d& m) {
  return 0.5 * Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

Vector3d velocity_at(const std::vector<Matrix3d>& axes, std::int64_t f, double rate_hz) {
  Matrix3d rate = Matrix3d::Zero();
  for (std::int64_t k = 1; k <= kDynamicsMargin; ++k)
    rate += kFirst[at(k - 1)] * (axes[at(f + k)] - axes[at(f - k)]);
  return axial(rate * axes[at(f)].transpose()) * rate_hz;
}

// R'' R^T = [alpha] + [w][w], of which the second part is symmetric.
Vector3d acceleration_at(const std::vector<Matrix3d>& axes, std::int64_t f, double rate_hz) {
  Matrix3d rate = kSecondOfItself * axes[at(f)];
  for (std::int64_t k = 1; k <= kDynamicsMargin; ++k)
    rate += kSecond[at(k - 1)] * (axes[at(f + k)] + axes[at(f - k)]);
  return axial(rate * axes[at(f)].transpose()) * rate_hz * rate_hz;
}

}  // namespace

WrenchTrack WrenchTrack::zero(std::int64_t frames) {
  return {.force = MatrixX3d::Zero(frames, 3), .moment = MatrixX3d::Zero(frames, 3)};
}

WrenchTrack& WrenchTrack::operator+=(const WrenchTrack& other) {
  force += other.force;
  moment += other.moment;
  return *this;
}

Vector3d WrenchTrack::moment_about(const Vector3d& point, std::int64_t f) const {
  const Vector3d about_origin = moment.row(f), push = force.row(f);
  return about_origin - point.cross(push);
}

WrenchTrack inertial_wrench(const BodyTrack& body, const Vector3d& gravity, double rate_hz) {
  const std::int64_t frames = body.centre.rows();
  WrenchTrack out{.force = MatrixX3d::Constant(frames, 3, kNaN),
                  .moment = MatrixX3d::Constant(frames, 3, kNaN)};
  const Vector3d inertia = body.mass * body.gyration.cwiseAbs2();
  for (std::int64_t f = kDynamicsMargin; f < frames - kDynamicsMargin; ++f) {
    Vector3d second = kSecondOfItself * body.centre.row(f).transpose();
    for (std::int64_t k = 1; k <= kDynamicsMargin; ++k)
      second += kSecond[at(k - 1)] * (body.centre.row(f + k) + body.centre.row(f - k)).transpose();
    const Vector3d force = body.mass * (gravity - second * rate_hz * rate_hz);
    const Matrix3d& r = body.axes[at(f)];
    const Vector3d w = r.transpose() * velocity_at(body.axes, f, rate_hz);
    const Vector3d alpha = r.transpose() * acceleration_at(body.axes, f, rate_hz);
    const Vector3d momentum = inertia.cwiseProduct(w);
    const Vector3d rate = inertia.cwiseProduct(alpha) + w.cross(momentum);
    out.force.row(f) = force;
    out.moment.row(f) = Vector3d(body.centre.row(f)).cross(force) - r * rate;
  }
  return out;
}

MatrixX3d angular_velocity(const std::vector<Matrix3d>& axes, double rate_hz) {
  const auto frames = std::ssize(axes);
  MatrixX3d out = MatrixX3d::Constant(frames, 3, kNaN);
  for (std::int64_t f = kDynamicsMargin; f < frames - kDynamicsMargin; ++f)
    out.row(f) = velocity_at(axes, f, rate_hz);
  return out;
}

}  // namespace kinemark::analysis
