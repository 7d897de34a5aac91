// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/rivals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

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

/// A ball at x all the time.
Place ball(double x, double gap_m) {
  Place place;
  place.a = {0, 1, 2};
  place.b = {3, 4, 5};
  place.gap_m = gap_m;
  place.turn_rad = {0.3, 0.3, 0.3};
  place.path = Eigen::Vector3d(x, 0.0, 0.0).replicate(1, 10);
  return place;
}

TEST(Rivals, PositionsThatAgreeAreOneJoint) {
  const std::vector<Rival> rivals{
      {{}, 0.5, {ball(0.0, 0.002)}}, {{}, 0.3, {ball(0.008, 0.002)}}, {{}, 0.2, {}}};
  const auto found = find_agreements(rivals);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].members.size(), 2U);
  EXPECT_EQ(found[0].members[0].rival, 0U);
  EXPECT_NEAR(found[0].weight, 0.8, 1e-12);
  EXPECT_NEAR(found[0].spread_m, 0.008 * std::sqrt(0.3 / 0.8), 1e-12);
  EXPECT_EQ(found[0].rival_weight, 0.0);
}

TEST(Rivals, AnotherJointNearByCountsAgainst) {
  // 100 mm away, as good; 100 mm away with a gap of three times; 400 mm away.
  for (const auto& [x, gap, counts] :
       {std::tuple{0.1, 0.002, true}, {0.1, 0.006, false}, {0.4, 0.002, false}}) {
    const std::vector<Rival> rivals{{{}, 0.6, {ball(0.0, 0.002)}}, {{}, 0.4, {ball(x, gap)}}};
    const auto found = find_agreements(rivals);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0].rival_weight, counts ? 0.4 : 0.0, 1e-12) << x << " " << gap;
    EXPECT_EQ(found[0].others.size(), counts ? 1U : 0U);
  }
}

TEST(Rivals, ARivalThatHasBothDoesNotCount) {
  const std::vector<Rival> rivals{{{}, 0.6, {ball(0.0, 0.002), ball(0.1, 0.002)}},
                                  {{}, 0.4, {ball(0.1, 0.002)}}};
  const auto found = find_agreements(rivals);
  ASSERT_EQ(found.size(), 2U);
  const auto& both = found[0].weight > 0.9 ? found[0] : found[1];
  EXPECT_EQ(both.rival_weight, 0.0);
}

TEST(Rivals, ARigidChainHasOneSegmentationThatMatters) {
  const auto chain = testing::make_chain({.frames = 200,
                                          .lengths_m = {0.12, 0.15, 0.16},
                                          .per_segment = 4,
                                          .stagger_m = 0.03,
                                          .noise_sd_m = 0.005});
  const Samples samples{chain.markers, {}};
  const auto topology = find_topology(chain.markers).value();
  const auto rivals = find_rivals(samples, topology, {});
  double weight = 0.0, right = 0.0;
  std::vector<std::vector<int>> truth;
  for (const auto& segment : chain.layout.segments) truth.push_back(segment.markers);
  for (const auto& rival : rivals) {
    weight += rival.weight;
    if (rival.clusters == truth) right += rival.weight;
  }
  EXPECT_NEAR(weight, 1.0, 1e-12);
  EXPECT_GT(right, 0.8) << "thresholds lie beyond the noise";
}

}  // namespace

}  // namespace kinemark::skeleton::internal
