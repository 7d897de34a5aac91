// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

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

std::vector<SegmentPoses> poses_of(const testing::TestChain& chain, const Samples& samples) {
  std::vector<SegmentPoses> poses;
  for (const auto& s : chain.layout.segments) poses.push_back(find_segment_poses(samples, s.name, s.markers));
  return poses;
}

PairSpread pairs_of(const Samples& samples) {
  std::vector<int> markers(static_cast<std::size_t>(samples.trajectories.markers()));
  std::iota(markers.begin(), markers.end(), 0);
  std::vector<std::int64_t> frames(static_cast<std::size_t>(samples.trajectories.frames()));
  std::iota(frames.begin(), frames.end(), 0);
  return measure_pairs(samples, markers, frames, 20);
}

const std::vector<int> kThreeSegments{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};

TEST(Edges, ExactDataShareTheirPointExactly) {
  const auto chain = testing::make_chain({.frames = 100, .lengths_m = {0.12, 0.15, 0.16}, .per_segment = 4});
  const Samples samples{chain.markers, {}};
  const auto edges = find_edges(samples, poses_of(chain, samples), kThreeSegments, pairs_of(samples));
  ASSERT_EQ(edges.size(), 3U) << "every pair of three segments was seen together";
  for (const Edge& e : edges) {
    EXPECT_LT(e.a, e.b);
    EXPECT_GE(e.cost_m, e.residual_m);
    if (e.b == e.a + 1) {
      EXPECT_LT(e.residual_m, 0.001) << e.a;
    } else {
      EXPECT_GT(e.residual_m, 0.03);
    }
  }
  const auto tree = spanning_tree(edges, 3);
  ASSERT_EQ(tree.size(), 2U);
  for (const TreeEdge& t : tree) {
    EXPECT_EQ(t.edge.b, t.edge.a + 1) << "the chain's own joints";
    EXPECT_GT(t.margin, 2.0);
  }
}

TEST(Edges, ASegmentWithoutPosesIsAPointOnASphere) {
  auto chain = testing::make_chain({.frames = 100, .lengths_m = {0.12, 0.15, 0.16}, .per_segment = 4});
  for (std::int64_t f = 0; f < 100; ++f)
    for (const std::int64_t m : {9, 10, 11}) chain.markers.set_missing(f, m);
  const Samples samples{chain.markers, {}};
  const auto poses = poses_of(chain, samples);
  ASSERT_EQ(poses[2].known_frames, 0);
  for (const Edge& e : find_edges(samples, poses, kThreeSegments, pairs_of(samples)))
    if (e.a == 1 && e.b == 2) {
      EXPECT_LT(e.residual_m, 0.001);
    }
}

TEST(Edges, SegmentsThatWereNeverSeenTogetherHaveNone) {
  auto chain = testing::make_chain({.frames = 100, .per_segment = 4});
  for (std::int64_t f = 0; f < 100; ++f)
    for (std::int64_t m = 0; m < 4; ++m) chain.markers.set_missing(f, f % 2 == 0 ? m : 4 + m);
  const Samples samples{chain.markers, {}};
  EXPECT_TRUE(
      find_edges(samples, poses_of(chain, samples), {0, 0, 0, 0, 1, 1, 1, 1}, pairs_of(samples)).empty());
  EXPECT_TRUE(spanning_tree({}, 2).empty());
}

}  // namespace
}  // namespace kinemark::skeleton::internal
