// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Symmetric 3 x 3 matrices as six numbers, the upper triangle row by row: xx xy xz yy yz zz. So covariances
// are stored in data/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

namespace kinemark::math {

/// Where xx, yy and zz stand among the six.
inline constexpr std::array<std::size_t, 3> kSymmetric3Diagonal{0, 3, 5};

/// An element off the diagonal among the six, and the two diagonal ones of its row and column.
struct Symmetric3Pair {
  std::size_t index;   ///< index of the element
  std::size_t row;     ///< index of the diagonal element of its row
  std::size_t column;  ///< index of the diagonal element of its column
};
/// xy, xz and yz.
inline constexpr std::array<Symmetric3Pair, 3> kSymmetric3Pairs{{{1, 0, 3}, {2, 0, 5}, {4, 3, 5}}};

/// Write the upper triangle of `matrix`; what stands below the diagonal is not looked at.
inline void pack_symmetric3(const Eigen::Matrix3d& matrix, double* six) {
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = row; column < 3; ++column) *six++ = matrix(row, column);
}

/// The same of `value` times the identity.
inline void pack_isotropic3(double value, double* six) {
  std::fill_n(six, 6, 0.0);
  for (const std::size_t k : kSymmetric3Diagonal) six[k] = value;
}

/// The full matrix of the six.
[[nodiscard]] inline Eigen::Matrix3d unpack_symmetric3(const double* six) {
  return Eigen::Matrix3d{{six[0], six[1], six[2]}, {six[1], six[3], six[4]}, {six[2], six[4], six[5]}};
}

/// xx + yy + zz.
[[nodiscard]] inline double symmetric3_trace(const double* six) { return six[0] + six[3] + six[5]; }

}  // namespace kinemark::math
