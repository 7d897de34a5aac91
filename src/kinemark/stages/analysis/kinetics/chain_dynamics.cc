// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/chain_dynamics.h"

#include <Eigen/Geometry>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;

Vector3d axial(const Matrix3d& m) {
  return 0.5 * Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

// Frames [kDerivativeMargin, frames - kDerivativeMargin) of the axes' nine numbers, column by column.
PathSamples differentiated(const std::vector<Matrix3d>& axes, double rate_hz) {
  const auto frames = std::ssize(axes);
  SeriesMatrix x(frames, 9);
  for (std::int64_t f = 0; f < frames; ++f)
    x.row(f) = Eigen::Map<const Eigen::RowVectorXd>(axes[at(f)].data(), 9);
  return differentiate(x, kDerivativeMargin, frames - 2 * kDerivativeMargin, rate_hz);
}

// R' R^T = [w]; R'' R^T = [alpha] + [w][w], of which the second part is symmetric.
Vector3d turning(const PathMatrix& rates, std::int64_t i, const Matrix3d& axes) {
  const Eigen::RowVectorXd numbers = rates.row(i);
  return axial(Eigen::Map<const Matrix3d>(numbers.data()) * axes.transpose());
}

// Angular velocity by differences over `span` frames to either side, in the laboratory; NaN at the ends.
MatrixX3d velocity_over(const std::vector<Matrix3d>& axes, double rate_hz, std::int64_t span) {
  const auto frames = std::ssize(axes);
  MatrixX3d out = MatrixX3d::Constant(frames, 3, kNaN);
  const double per_s = rate_hz / static_cast<double>(2 * span);
  for (std::int64_t f = span; f + span < frames; ++f)
    out.row(f) = axial(per_s * (axes[at(f + span)] - axes[at(f - span)]) * axes[at(f)].transpose());
  return out;
}

bool too_short(std::int64_t frames) { return frames <= 2 * kDerivativeMargin; }

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

WrenchTrack inertial_wrench(const BodyTrack& body, const Vector3d& gravity, double rate_hz,
                            std::int64_t angular_span) {
  const std::int64_t frames = body.centre.rows();
  WrenchTrack out{.force = MatrixX3d::Constant(frames, 3, kNaN),
                  .moment = MatrixX3d::Constant(frames, 3, kNaN)};
  if (too_short(frames)) return out;
  const Vector3d inertia = body.mass * body.gyration.cwiseAbs2();
  const auto centre =
      differentiate(SeriesMatrix(body.centre), kDerivativeMargin, frames - 2 * kDerivativeMargin, rate_hz);
  const auto axes = differentiated(body.axes, rate_hz);
  const MatrixX3d velocity = angular_span > 0 ? velocity_over(body.axes, rate_hz, angular_span) : MatrixX3d();
  for (std::int64_t i = 0; i < centre.count(); ++i) {
    const std::int64_t f = i + kDerivativeMargin;
    const Vector3d force = body.mass * (gravity - Vector3d(centre.a.row(i)));
    const Matrix3d& r = body.axes[at(f)];
    Vector3d w = turning(axes.v, i, r), alpha = turning(axes.a, i, r);
    if (angular_span > 0) {
      w = velocity.row(f);
      alpha = (velocity.row(f + angular_span) - velocity.row(f - angular_span)) * rate_hz /
              static_cast<double>(2 * angular_span);
    }
    w = r.transpose() * w;
    alpha = r.transpose() * alpha;
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
  if (too_short(frames)) return out;
  const auto rates = differentiated(axes, rate_hz);
  for (std::int64_t i = 0; i < rates.count(); ++i)
    out.row(i + kDerivativeMargin) = turning(rates.v, i, axes[at(i + kDerivativeMargin)]);
  return out;
}

}  // namespace kinemark::analysis
