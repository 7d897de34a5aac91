// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Rigid motions that lay points over points in the least-squares sense. Kabsch (1976), Acta Cryst. A32:922;
// Umeyama (1991), IEEE PAMI 13:376.
#pragma once

#include "kinemark/math/se3.h"

namespace kinemark::math {

/// The rotation that takes one set of points to another, and how well they tell it.
struct RotationFit {
  Matrix3d rotation = Matrix3d::Identity();  ///< target_from_source; proper also where `mirrored`
  /// How well the points tell the rotation: (s2 + s3) / s1 of the sum's singular values, s3 negative where
  /// `mirrored`; 0 to 2. It vanishes where all points of one side lie on a line or coincide, and for mirror
  /// images that have no best rotation; then `rotation` is one of many that fit alike.
  double margin = 0.0;
  bool mirrored = false;  ///< a reflection would fit better: sides confused, or noise on points of a plane

  /// Whether the points tell the rotation.
  [[nodiscard]] bool determined() const { return margin > 1e-9; }
};

/// Rotation R that minimises sum w |target - R source|^2, both with their weighted means taken off.
///
/// @param target_source  sum of w target source', any unit
/// @return  one of the best rotations where they are many: ask determined(). O(1), allocates nothing.
[[nodiscard]] RotationFit fit_rotation(const Matrix3d& target_source);

/// The rigid motion that takes one set of points to another.
struct RigidFit {
  SE3 target_from_source;  ///< in the unit of the points
  RotationFit rotation;    ///< of the same motion, with what is known about it
};

/// Rigid motion that minimises sum |target - (R source + t)|^2.
///
/// @param source  3 x n points, n at least 1, finite
/// @param target  3 x n points, in the order of `source`
/// O(n) time, two copies.
[[nodiscard]] RigidFit fit_rigid(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target);

}  // namespace kinemark::math
