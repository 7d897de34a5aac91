// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/linkage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::skeleton::internal {
namespace {

using Clusters = std::vector<std::vector<int>>;

Eigen::MatrixXd distances_of(const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd d(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      d(i, j) = std::abs(x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(j)]);
  return d;
}

TEST(Linkage, MeansOfDistancesDecide) {
  // Two pairs at 1 and 3; their mean distance is 10.
  const Linkage linkage(distances_of({0.0, 10.0, 1.0, 12.0}));
  EXPECT_EQ(linkage.cut(0.5), (Clusters{{0}, {1}, {2}, {3}}));
  EXPECT_EQ(linkage.cut(1.0), (Clusters{{0, 2}, {1}, {3}}));
  EXPECT_EQ(linkage.cut(2.5), (Clusters{{0, 2}, {1, 3}}));
  EXPECT_EQ(linkage.cut(10.4), (Clusters{{0, 2}, {1, 3}}));
  EXPECT_EQ(linkage.cut(10.5), (Clusters{{0, 1, 2, 3}}));
}

TEST(Linkage, SizesWeigh) {
  // Three at 0, one at 4 joins them at 4; the mean from 10 is then (3 x 10 + 6) / 4 = 9.
  const Linkage linkage(distances_of({0.0, 0.0, 0.0, 4.0, 10.0}));
  EXPECT_EQ(linkage.cut(8.9).size(), 2U);
  EXPECT_EQ(linkage.cut(9.0).size(), 1U);
}

TEST(Linkage, NothingAndOne) {
  EXPECT_TRUE(Linkage(Eigen::MatrixXd(0, 0)).cut(1.0).empty());
  EXPECT_EQ(Linkage(Eigen::MatrixXd::Zero(1, 1)).cut(0.0), (Clusters{{0}}));
}

}  // namespace
}  // namespace kinemark::skeleton::internal
