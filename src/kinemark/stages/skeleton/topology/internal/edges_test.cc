// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::internal {
namespace {

TEST(Edges, NeighboursShareAPointToTheNoise) {
  const auto chain = testing::make_chain(
      {.lengths_m = {0.12, 0.15, 0.16}, .per_segment = 4, .noise_sd_m = 0.001, .missing = 0.1});
  const Samples samples{chain.markers, {}};
  std::vector<SegmentPoses> poses;
  for (const auto& s : chain.layout.segments) poses.push_back(find_segment_poses(samples, s.name, s.markers));
  for (const int a : {0, 1}) {
    const auto i = static_cast<std::size_t>(a);
    const double gap = shared_point_residual(samples, poses[i], poses[i + 1]);
    EXPECT_GT(gap, 0.0007);
    EXPECT_LT(gap, 0.006) << "noise of one millimetre, an arm's length from the markers";
  }
  EXPECT_GT(shared_point_residual(samples, poses[0], poses[2]), 0.03);
  poses[0].known.assign(poses[0].known.size(), 0);
  EXPECT_TRUE(std::isnan(shared_point_residual(samples, poses[0], poses[1])));
}

Edge edge(int a, int b, double cost) { return {.a = a, .b = b, .residual_m = cost, .cost_m = cost}; }

TEST(Edges, TheTreeIsTheCheapestAndKnowsItsReplacements) {
  const auto tree = spanning_tree(
      {edge(0, 1, 1.0), edge(1, 2, 2.0), edge(0, 2, 5.0), edge(2, 3, 3.0), edge(0, 3, 12.0)}, 4);
  ASSERT_EQ(tree.size(), 3U);
  EXPECT_EQ(tree[0].edge.cost_m, 1.0);
  EXPECT_EQ(tree[0].margin, 5.0);
  EXPECT_EQ(tree[1].margin, 2.5);
  EXPECT_EQ(tree[2].margin, 4.0);
}

TEST(Edges, PartsWithoutPairsStayApart) {
  const auto tree = spanning_tree({edge(0, 1, 1.0), edge(2, 3, 2.0)}, 4);
  ASSERT_EQ(tree.size(), 2U);
  EXPECT_EQ(tree[0].margin, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kinemark::skeleton::internal
