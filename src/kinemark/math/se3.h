// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::math {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Matrix [v] with [v] x = v cross x.
[[nodiscard]] inline Matrix3d skew(const Vector3d& v) {
  return Matrix3d{{0.0, -v.z(), v.y()}, {v.z(), 0.0, -v.x()}, {-v.y(), v.x(), 0.0}};
}

/// Rigid transform target_from_source: x_in_target = rotation * x_in_source + translation.
struct SE3 {
  Matrix3d rotation = Matrix3d::Identity();  ///< 3 x 3, orthonormal, determinant 1
  Vector3d translation = Vector3d::Zero();   ///< m

  /// A point taken to the other frame, m.
  [[nodiscard]] Vector3d operator*(const Vector3d& x) const { return rotation * x + translation; }
  /// a_from_b * b_from_c = a_from_c.
  [[nodiscard]] SE3 operator*(const SE3& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  /// b_from_a of a_from_b.
  [[nodiscard]] SE3 inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

}  // namespace kinemark::math
