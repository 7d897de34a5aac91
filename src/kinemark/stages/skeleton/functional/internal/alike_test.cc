// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/alike.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::internal {
namespace {

/// Columns that keep so much of themselves from frame to frame.
Eigen::MatrixXd path(double keeps, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed, 1);
  Eigen::MatrixXd out(20000, columns);
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index i = 0; i < out.rows(); ++i)
      out(i, c) = (i == 0 ? 0.0 : keeps * out(i - 1, c)) + std::sqrt(1.0 - keeps * keeps) * random.gaussian();
  return out;
}

TEST(FramesAlike, IndependentErrorsCountEach) {
  EXPECT_NEAR(frames_alike(path(0.0, 3, 1), path(0.9, 3, 2)), 1.0, 0.15);
  EXPECT_NEAR(frames_alike(path(0.9, 3, 1), path(0.0, 3, 2)), 1.0, 0.15)
      << "a regressor that repeats nothing averages any error";
}

TEST(FramesAlike, TwoFirstOrderPathsCountByTheirProduct) {
  const double both = 0.9 * 0.8;
  EXPECT_NEAR(frames_alike(path(0.9, 6, 3), path(0.8, 6, 4)), (1.0 + both) / (1.0 - both), 0.7);
}

TEST(FramesAlike, IsOneAtLeastAndWhereNothingIsKnown) {
  EXPECT_EQ(frames_alike(path(-0.9, 1, 5), path(0.9, 1, 6)), 1.0);
  EXPECT_EQ(frames_alike(Eigen::MatrixXd::Zero(100, 3), path(0.9, 1, 6).topRows(100)), 1.0);
  EXPECT_EQ(frames_alike(Eigen::MatrixXd::Ones(5, 1), Eigen::MatrixXd::Ones(5, 1)), 1.0);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
