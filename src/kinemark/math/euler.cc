// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/euler.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace kinemark::math {

Matrix3d axis_angle(const Vector3d& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

Matrix3d from_body_xyz(const Vector3d& angles_rad) {
  return axis_angle(Vector3d::UnitX(), angles_rad.x()) * axis_angle(Vector3d::UnitY(), angles_rad.y()) *
         axis_angle(Vector3d::UnitZ(), angles_rad.z());
}

Vector3d to_body_xyz(const Matrix3d& R) {
  // R = Rx(a) Ry(b) Rz(c): first row (cos b cos c, -cos b sin c, sin b), last column (sin b, -sin a cos b,
  // cos a cos b).
  const double cos_b = std::hypot(R(0, 0), R(0, 1));
  const double b = std::atan2(R(0, 2), cos_b);
  if (cos_b < 1e-15) return {std::atan2(R(2, 1), R(1, 1)), b, 0.0};
  // Near b = +-90 deg only the sum or the difference of a and c is well determined, so c must follow from the
  // a chosen: the second row of Rx(-a) R is (sin c, cos c, 0).
  const double a = std::atan2(-R(1, 2), R(2, 2));
  const double sin_a = std::sin(a), cos_a = std::cos(a);
  return {a, b, std::atan2(cos_a * R(1, 0) + sin_a * R(2, 0), cos_a * R(1, 1) + sin_a * R(2, 1))};
}

namespace {

/// The angle congruent to `angle` that lies nearest to `near`.
double unwrap(double angle, double near) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  return angle + kTwoPi * std::round((near - angle) / kTwoPi);
}

}  // namespace

Vector3d to_angles_about(const Matrix3d& axes, const Matrix3d& rotation, const Vector3d& near_rad) {
  // In the basis of the axes the product is body-fixed X-Y-Z; a left-handed basis reverses the sign of every
  // angle.
  const double handedness = axes.determinant() > 0.0 ? 1.0 : -1.0;
  const Matrix3d R = axes.transpose() * rotation * axes;
  const Vector3d near = handedness * near_rad;
  const double cos_b = std::hypot(R(0, 0), R(0, 1));
  Vector3d best;
  if (cos_b < 1e-9) {
    // sin b = +-1: R(2,1) and R(1,1) are the sine and cosine of a +- c; keep a.
    const double sum = std::atan2(R(2, 1), R(1, 1));
    const double sign = R(0, 2) > 0.0 ? 1.0 : -1.0;
    best = {near.x(), std::copysign(std::numbers::pi / 2.0, R(0, 2)), sign * (sum - near.x())};
    best.y() = unwrap(best.y(), near.y());
    best.z() = unwrap(best.z(), near.z());
  } else {
    double best_distance = INFINITY;
    for (const double sign : {1.0, -1.0}) {
      Vector3d t(std::atan2(-sign * R(1, 2), sign * R(2, 2)), std::atan2(R(0, 2), sign * cos_b),
                 std::atan2(-sign * R(0, 1), sign * R(0, 0)));
      for (int i = 0; i < 3; ++i) t[i] = unwrap(t[i], near[i]);
      const double distance = (t - near).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = t;
      }
    }
  }
  return handedness * best;
}

Matrix3d exp_so3(const Vector3d& v) {
  const double angle2 = v.squaredNorm();
  const double angle = std::sqrt(angle2);
  const double sine = angle > 1e-8 ? std::sin(angle) / angle : 1.0 - angle2 / 6.0;
  const double half = angle > 1e-8 ? std::sin(0.5 * angle) / (0.5 * angle) : 1.0 - angle2 / 24.0;
  const double versine = 0.5 * half * half;
  Matrix3d R;
  // I + sine [v] + versine [v]^2, with [v]^2 = v v^T - |v|^2 I.
  R(0, 0) = 1.0 + versine * (v[0] * v[0] - angle2);
  R(1, 1) = 1.0 + versine * (v[1] * v[1] - angle2);
  R(2, 2) = 1.0 + versine * (v[2] * v[2] - angle2);
  R(0, 1) = versine * v[0] * v[1] - sine * v[2];
  R(1, 0) = versine * v[0] * v[1] + sine * v[2];
  R(0, 2) = versine * v[0] * v[2] + sine * v[1];
  R(2, 0) = versine * v[0] * v[2] - sine * v[1];
  R(1, 2) = versine * v[1] * v[2] - sine * v[0];
  R(2, 1) = versine * v[1] * v[2] + sine * v[0];
  return R;
}

Vector3d log_so3(const Matrix3d& rotation) {
  const Eigen::AngleAxisd aa(rotation);
  return aa.angle() * aa.axis();
}

}  // namespace kinemark::math
