// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::internal {
namespace {

TEST(Drawn, FramesAreSpreadEvenly) {
  EXPECT_EQ(draw_evenly(10, 5), (std::vector<std::int64_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(draw_evenly(3, 5), (std::vector<std::int64_t>{0, 1, 2})) << "no more than there are";
  EXPECT_TRUE(draw_evenly(0, 5).empty());
  const auto many = draw_evenly(1'000'003, 600);
  ASSERT_EQ(many.size(), 600U);
  for (std::size_t i = 1; i < many.size(); ++i) {
    EXPECT_GE(many[i] - many[i - 1], 1666);
    EXPECT_LE(many[i] - many[i - 1], 1667);
  }
}

TEST(Drawn, ACutHasTheSamplesOfItsFrames) {
  auto markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 4});
  for (std::int64_t f = 0; f < 4; ++f)
    for (int m = 0; m < 2; ++m) {
      if (f == 2 && m == 1) continue;
      markers.x(f, m) = Eigen::Vector3d(static_cast<double>(f), m, 0.0);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto part = cut(markers, {1, 2});
  EXPECT_EQ(part.frames(), 2);
  EXPECT_EQ(part.names, markers.names);
  EXPECT_EQ(part.x(0, 1), markers.x(1, 1));
  EXPECT_TRUE(part.present(1, 0));
  EXPECT_FALSE(part.present(1, 1)) << "missing in the recording";
  Array<std::uint8_t> mask(8, 1);
  mask[markers.index(1, 0)] = 0;
  EXPECT_FALSE(cut(markers, {1}, mask).present(0, 0));
  EXPECT_TRUE(cut(markers, {1}, mask).present(0, 1));
}

PairSpread spread_of(const testing::TestChain& chain) {
  std::vector<int> markers(static_cast<std::size_t>(chain.markers.markers()));
  std::iota(markers.begin(), markers.end(), 0);
  std::vector<std::int64_t> frames(static_cast<std::size_t>(chain.markers.frames()));
  std::iota(frames.begin(), frames.end(), 0);
  return measure_pairs({chain.markers, {}}, markers, frames, 20);
}

TEST(Pairs, VarianceWithinASegmentIsTwiceTheNoises) {
  const auto chain = testing::make_chain({.frames = 2000, .noise_sd_m = 0.001});
  const auto pairs = spread_of(chain);
  EXPECT_NEAR(pairs.variance(0, 1) / 2e-6, 1.0, 0.1);
  EXPECT_GT(pairs.variance(0, 4), 1e-4);
  EXPECT_EQ(pairs.variance(0, 4), pairs.variance(4, 0));
  EXPECT_TRUE(std::isnan(pairs.variance(2, 2)));
  EXPECT_EQ(pairs.frames(0, 4), 2000.0);
  EXPECT_NEAR(pairs.correlation(0, 1), 0.0, 0.1);
  const auto same = describe_same_segment(pairs, 0.0);
  EXPECT_NEAR(std::sqrt(same.noise_variance), 0.001, 1e-4);
  EXPECT_EQ(same.soft_sd_m, 0.0);
  EXPECT_GT(same.independent, 0.8);
  EXPECT_EQ(describe_same_segment(pairs, 0.003).noise_variance, 9e-6);
  EXPECT_NEAR(noise_within(pairs, {0, 0, 0, 1, 1, 1}), 1e-6, 5e-8);
  EXPECT_TRUE(std::isnan(noise_within(pairs, {0, 1, 2, 3, 4, 5})));
}

TEST(Pairs, SlowWobbleIsSoftTissueNotMotion) {
  auto chain =
      testing::make_chain({.frames = 1200, .per_segment = 5, .stagger_m = 0.03, .noise_sd_m = 0.0003});
  // Each marker wobbles on its own by 3 mm and slowly.
  Random random(3, 1);
  for (std::int64_t m = 0; m < chain.markers.markers(); ++m) {
    Eigen::Vector3d wobble = Eigen::Vector3d::Zero();
    for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
      for (double& w : wobble) w = 0.98 * w + 0.003 * std::sqrt(1.0 - 0.98 * 0.98) * random.gaussian();
      const auto& rotations = chain.world_from_segment[m < 5 ? 0 : 1];
      chain.markers.x(f, m) += rotations[static_cast<std::size_t>(f)] * wobble;
    }
  }
  const auto pairs = spread_of(chain);
  const auto same = describe_same_segment(pairs, 0.0);
  EXPECT_GT(same.soft_sd_m, 0.001);
  EXPECT_LT(same.soft_sd_m, 0.006);
  EXPECT_LT(same.independent, 0.05);
  const auto segment = cluster(log_odds(pairs, same, {}), pairs);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(segment[i], i < 5 ? 0 : 1) << i;
}

TEST(Pairs, OddsHaveTheRightSignAndSaturate) {
  const auto chain = testing::make_chain({.frames = 400, .noise_sd_m = 0.002});
  const auto pairs = spread_of(chain);
  const auto odds = log_odds(pairs, describe_same_segment(pairs, 0.0), {});
  EXPECT_EQ(odds(0, 1), odds(1, 0));
  EXPECT_GT(odds(0, 1), 10.0);
  EXPECT_EQ(odds(0, 4), -50.0);
  EXPECT_EQ(odds(3, 3), 0.0);
}

TEST(Pairs, ClustersAreNumberedByFirstMarkerAndSinglesMove) {
  PairSpread pairs;
  pairs.variance = pairs.correlation = pairs.frames = Eigen::MatrixXd::Ones(5, 5);
  Eigen::MatrixXd odds = Eigen::MatrixXd::Constant(5, 5, -10.0);
  const auto link = [&](int i, int j, double v) { odds(i, j) = odds(j, i) = v; };
  // 1 and 2 are the closest pair, but 2 fits 3 and 4 better on the whole.
  link(1, 2, 12.0);
  link(3, 4, 11.0);
  link(2, 3, 9.0);
  link(2, 4, 9.0);
  link(0, 1, 11.5);
  link(0, 2, -5.0);
  EXPECT_EQ(cluster(odds, pairs), (std::vector<int>{0, 0, 1, 1, 1}));
  EXPECT_EQ(mean_odds(odds, pairs, {0, 0, 1, 1, 1}, 2, 1), 9.0);
  EXPECT_EQ(mean_odds(odds, pairs, {0, 0, 1, 1, 1}, 2, 0), 3.5);
  EXPECT_TRUE(std::isnan(mean_odds(odds, pairs, {0, 1, 1, 1, 1}, 0, 0)));
  EXPECT_EQ(least_odds(odds, pairs, {0, 0, 0, 1, 1}, 0), -5.0);
  EXPECT_EQ(least_odds(odds, pairs, {0, 1, 1, 1, 1}, 0), 0.0);
}

TEST(Pairs, TooFewFramesTogetherAreUnknownAndNoEvidence) {
  auto chain = testing::make_chain({.frames = 60, .noise_sd_m = 0.001});
  for (std::int64_t f = 10; f < 60; ++f) chain.markers.set_missing(f, 0);
  const auto pairs = spread_of(chain);
  EXPECT_EQ(pairs.frames(0, 1), 10.0);
  EXPECT_TRUE(std::isnan(pairs.variance(0, 1)));
  EXPECT_TRUE(std::isnan(pairs.correlation(1, 0)));
  EXPECT_FALSE(std::isnan(pairs.variance(1, 2)));
  const auto odds = log_odds(pairs, describe_same_segment(pairs, 0.0), {});
  EXPECT_EQ(odds(0, 1), 0.0);
  EXPECT_EQ(odds(4, 0), 0.0);
}

TEST(Pairs, MaskedSamplesAreNotSeen) {
  const auto chain = testing::make_chain({.frames = 40});
  std::vector<std::uint8_t> mask(40 * 6, 1);
  for (std::size_t f = 0; f < 15; ++f) mask[6 * f + 2] = 0;
  std::vector<std::int64_t> frames(40);
  std::iota(frames.begin(), frames.end(), 0);
  const auto pairs = measure_pairs({chain.markers, mask}, {0, 2}, frames, 20);
  EXPECT_EQ(pairs.frames(0, 1), 25.0);
  EXPECT_LT(pairs.variance(0, 1), 1e-20) << "exact data of one segment";
}

TEST(Pairs, NothingSeenHasNoNoise) {
  PairSpread pairs;
  pairs.variance = pairs.correlation = Eigen::MatrixXd::Constant(2, 2, std::nan(""));
  pairs.frames = Eigen::MatrixXd::Zero(2, 2);
  const auto same = describe_same_segment(pairs, 0.001);
  EXPECT_EQ(same.noise_variance, 0.0);
  EXPECT_EQ(same.independent, 1.0);
  EXPECT_EQ(log_odds(pairs, same, {}).norm(), 0.0);
}

// The same pair, its distance spread ever wider: ever less likely on one segment.
TEST(Pairs, OddsFallWithTheSpread) {
  PairSpread pairs;
  pairs.variance = pairs.correlation = Eigen::MatrixXd::Zero(2, 2);
  pairs.frames = Eigen::MatrixXd::Constant(2, 2, 100.0);
  double before = 51.0;
  for (const double sd_m : {0.001, 0.003, 0.01, 0.05}) {
    pairs.variance(0, 1) = pairs.variance(1, 0) = sd_m * sd_m;
    const double now = log_odds(pairs, {.noise_variance = 1e-6}, {})(0, 1);
    EXPECT_LE(now, before) << sd_m;
    before = now;
  }
  EXPECT_EQ(before, -50.0);
}

}  // namespace

}  // namespace kinemark::skeleton::internal
