// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace kinemark::math {

/// Residual of four readings of a source with known shares and unknown strength; the strength is eliminated.
///
/// Least squares over the strength s of |readings - s shares|^2 leaves s = shares . readings / shares .
/// shares and a residual orthogonal to the shares, given here in an orthonormal basis of that space. So
/// its square is the misfit, its three parts are independent with the variance of a reading, and its
/// derivative is basis * (d readings - scale * d shares), except for a term that vanishes with the misfit.
/// Golub & Pereyra (1973), SIAM J. Numer. Anal. 10:413; Kaufman (1975), BIT 15:49.
struct ScaleFree {
  double scale = 0.0;                 ///< s, readings per share
  Eigen::Matrix<double, 3, 4> basis;  ///< rows: orthonormal, at right angles to the shares
  Eigen::Vector3d residual;           ///< basis * readings
};

/// `shares` must not be zero; its first element may have any sign. O(1), allocates nothing.
[[nodiscard]] inline ScaleFree eliminate_scale(const Eigen::Vector4d& readings,
                                               const Eigen::Vector4d& shares) {
  ScaleFree out;
  const double square = shares.squaredNorm();
  out.scale = shares.dot(readings) / square;
  // Householder: H = I - v v' / h sends shares to the first axis; its other rows span what is at right
  // angles.
  const double norm = std::copysign(std::sqrt(square), shares(0));
  Eigen::Vector4d v = shares;
  v(0) += norm;
  const double h = square + norm * shares(0);
  out.basis = -v.tail<3>() * (v.transpose() / h);
  out.basis.rightCols<3>() += Eigen::Matrix3d::Identity();
  out.residual = out.basis * readings;
  return out;
}

}  // namespace kinemark::math
