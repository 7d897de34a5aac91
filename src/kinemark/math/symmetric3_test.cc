// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/symmetric3.h"

#include <gtest/gtest.h>

namespace kinemark::math {
namespace {

const Eigen::Matrix3d kMatrix{{1.0, 2.0, 3.0}, {2.0, 4.0, 5.0}, {3.0, 5.0, 6.0}};

TEST(Symmetric3, StoresTheUpperTriangleRowByRow) {
  std::array<double, 6> six{};
  pack_symmetric3(kMatrix, six.data());
  EXPECT_EQ(six, (std::array{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(unpack_symmetric3(six.data()), kMatrix);
  EXPECT_EQ(symmetric3_trace(six.data()), kMatrix.trace());
}

TEST(Symmetric3, DoesNotLookBelowTheDiagonal) {
  Eigen::Matrix3d lopsided = kMatrix;
  lopsided(1, 0) = lopsided(2, 0) = lopsided(2, 1) = -1.0;
  std::array<double, 6> six{};
  pack_symmetric3(lopsided, six.data());
  EXPECT_EQ(unpack_symmetric3(six.data()), kMatrix);
}

TEST(Symmetric3, TablesNameTheElements) {
  std::array<double, 6> six{};
  pack_symmetric3(kMatrix, six.data());
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_EQ(six[kSymmetric3Diagonal[axis]], kMatrix.diagonal()[static_cast<Eigen::Index>(axis)]);
  constexpr int kIndices[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [row, column] = kIndices[k];
    EXPECT_EQ(six[kSymmetric3Pairs[k].index], kMatrix(row, column));
    EXPECT_EQ(six[kSymmetric3Pairs[k].row], kMatrix(row, row));
    EXPECT_EQ(six[kSymmetric3Pairs[k].column], kMatrix(column, column));
  }
}

TEST(Symmetric3, IsotropicIsAMultipleOfTheIdentity) {
  std::array<double, 6> six{9.0, 9.0, 9.0, 9.0, 9.0, 9.0};
  pack_isotropic3(4.0, six.data());
  EXPECT_EQ(unpack_symmetric3(six.data()), 4.0 * Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace kinemark::math
