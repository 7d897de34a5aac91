// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Exchanges that were planted are found in exactly their frames, whatever their pattern; nothing else is.
#include "kinemark/math/exchanged_points.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using Frames = std::vector<std::int64_t>;

/// A foot of four points that swings on a leg and walks, with noise; two points more on the trunk.
struct Foot {
  std::int64_t frames = 240, points = 6;
  double rate_hz = 100.0;
  std::vector<double> x;

  explicit Foot(std::uint64_t seed = 1, double noise_m = 0.0005, std::int64_t count = 240) : frames(count) {
    Random random(seed, 7);
    const Eigen::Vector3d sites[] = {{0, 0, 0}, {0.20, 0, 0.02}, {0.17, 0, 0.07}, {0.05, 0.08, 0.03}};
    for (std::int64_t f = 0; f < frames; ++f) {
      const double t = static_cast<double>(f) / rate_hz, w = 2.0 * std::numbers::pi * 0.9;
      const Eigen::AngleAxisd turn(0.6 * std::sin(w * t), Eigen::Vector3d::UnitZ());
      const Eigen::Vector3d at(1.2 * t + 0.3 * std::sin(w * t), 0.1 + 0.05 * std::cos(w * t), 0.1);
      for (const auto& place : sites) add(at + turn * place, random, noise_m);
      add({1.2 * t, 1.0, 0.0}, random, noise_m);
      add({1.2 * t + 0.1, 1.2, 0.3 * std::sin(w * t)}, random, noise_m);
    }
  }
  void add(const Eigen::Vector3d& at, Random& random, double noise_m) {
    for (int axis = 0; axis < 3; ++axis) x.push_back(at[axis] + noise_m * random.gaussian());
  }
  void exchange(std::int64_t a, std::int64_t b, const Frames& where) {
    for (const auto f : where) std::swap_ranges(at(f, a), at(f, a) + 3, at(f, b));
  }
  void lose(std::int64_t p, std::int64_t first, std::int64_t last) {
    for (auto f = first; f <= last; ++f) std::fill_n(at(f, p), 3, kNan);
  }
  std::vector<double>::iterator at(std::int64_t f, std::int64_t p) {
    return x.begin() + 3 * (f * points + p);
  }
  [[nodiscard]] std::vector<ExchangedPair> find(const ExchangeSearch& search = {}) const {
    return find_exchanges({.x = x.data(), .frames = frames, .points = points, .rate_hz = rate_hz}, search);
  }
};

Frames every(std::int64_t step, std::int64_t first, std::int64_t last) {
  Frames frames;
  for (auto f = first; f <= last; f += step) frames.push_back(f);
  return frames;
}

TEST(ExchangedPoints, EveryPatternIsFoundInItsFrames) {
  for (const Frames& planted :
       {Frames{100}, Frames{0}, Frames{239}, every(1, 40, 90), every(2, 30, 99), every(3, 0, 239),
        every(4, 10, 200), every(5, 3, 180), Frames{4, 7, 8, 13, 20, 21, 22, 30, 90, 91}}) {
    Foot foot;
    foot.exchange(1, 2, planted);
    const auto found = foot.find();
    ASSERT_EQ(found.size(), 1U) << planted.front() << " " << planted.size();
    EXPECT_EQ(found[0].one, 1);
    EXPECT_EQ(found[0].other, 2);
    EXPECT_EQ(found[0].frames, planted);
    EXPECT_TRUE(found[0].side_known);
    EXPECT_GT(found[0].ratio, 4.0);
    EXPECT_NEAR(found[0].apart_m, std::hypot(0.03, 0.05), 0.002);
  }
}

TEST(ExchangedPoints, NothingIsFoundWhereNothingWasExchanged) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) EXPECT_TRUE(Foot(seed, 0.002).find().empty()) << seed;
  for (const std::int64_t frames : {0, 1, 2}) EXPECT_TRUE(Foot(1, 0.0005, frames).find().empty());
}

TEST(ExchangedPoints, OneThatLeapsToTheOtherAloneIsNoExchange) {
  Foot foot;
  for (const auto f : {50, 80, 81}) std::copy_n(foot.at(f, 2), 3, foot.at(f, 1));
  for (const auto f : {120, 150}) *foot.at(f, 1) += 0.3;
  EXPECT_TRUE(foot.find().empty());
}

TEST(ExchangedPoints, SeveralPairsAreKeptApart) {
  Foot foot;
  foot.exchange(1, 2, every(3, 0, 239));
  foot.exchange(0, 3, every(1, 100, 120));
  foot.exchange(4, 5, {60});
  std::set<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const auto& pair : foot.find()) {
    pairs.insert({pair.one, pair.other});
    if (pair.one == 0) {
      EXPECT_EQ(pair.frames, every(1, 100, 120));
    }
  }
  EXPECT_EQ(pairs, (std::set<std::pair<std::int64_t, std::int64_t>>{{0, 3}, {1, 2}, {4, 5}}));
}

TEST(ExchangedPoints, HalfTheFramesAreDecidedByDistancesOrNotAtAll) {
  Foot foot;
  foot.exchange(1, 2, every(2, 0, 239));
  const auto open = foot.find();
  ASSERT_EQ(open.size(), 1U);
  EXPECT_EQ(open[0].frames.size(), 120U);
  EXPECT_FALSE(open[0].side_known) << "either half may be right";
  const auto known = [](std::int64_t one, std::int64_t other, std::int64_t partner) {
    EXPECT_EQ(one + partner, 3) << "asked of the two that are exchanged";
    const double heel[] = {kNan, std::hypot(0.20, 0.02), std::hypot(0.17, 0.07), kNan, kNan, kNan};
    return other == 0 ? heel[one] : kNan;
  };
  const auto stated = foot.find({.distance = known});
  ASSERT_EQ(stated.size(), 1U);
  EXPECT_TRUE(stated[0].side_known);
  EXPECT_EQ(stated[0].frames, every(2, 0, 239));
  // The other half as well, though the foot looks the same.
  Foot other;
  other.exchange(1, 2, every(2, 1, 239));
  EXPECT_EQ(other.find({.distance = known}).at(0).frames, every(2, 1, 239));
}

TEST(ExchangedPoints, DistancesTieTogetherPathsThatAGapHasCut) {
  Foot foot;
  foot.lose(1, 100, 139);
  foot.exchange(1, 2, {50, 51});
  foot.exchange(1, 2, every(1, 140, 180));
  const auto found = foot.find();
  ASSERT_EQ(found.size(), 1U);
  Frames planted{50, 51};
  for (const auto f : every(1, 140, 180)) planted.push_back(f);
  EXPECT_EQ(found[0].frames, planted);
}

TEST(ExchangedPoints, LabelsAreFoundThroughAShortGapAndNotThroughALongOne) {
  for (const std::int64_t lost : {2, 8, 30}) {
    Foot foot(3, 0.0002);
    for (const std::int64_t p : {4, 5}) foot.lose(p, 100, 99 + lost);
    foot.exchange(4, 5, every(1, 100 + lost, 160));
    const auto found = foot.find();
    // Where the exchange ends both paths are seen.
    ASSERT_EQ(found.size(), 1U) << lost;
    EXPECT_EQ(found[0].frames.back(), 160);
    if (lost <= 8) {
      EXPECT_EQ(found[0].frames.front(), 100 + lost);
    }
  }
}

TEST(ExchangedPoints, PointsThatPassEachOtherNearbyAreLeftAlone) {
  Foot foot(5, 0.001);
  for (std::int64_t f = 0; f < foot.frames; ++f) {
    const double t = static_cast<double>(f - 120) / foot.rate_hz;
    auto a = foot.at(f, 4), b = foot.at(f, 5);
    const double ax[] = {3.0 * t, 1.0, 0.01}, bx[] = {-3.0 * t, 1.0, -0.01};
    std::copy_n(ax, 3, a);
    std::copy_n(bx, 3, b);
  }
  EXPECT_TRUE(foot.find().empty()) << "60 mm a frame, 20 mm beside each other";
}

TEST(ExchangedPoints, SizesAreComparedWithTheShortestDistance) {
  Foot foot;
  foot.exchange(1, 2, every(3, 0, 239));
  EXPECT_EQ(foot.find().size(), 1U);
  EXPECT_TRUE(foot.find({.least_m = 0.1}).empty()) << "they are 58 mm apart";
}

}  // namespace
}  // namespace kinemark::math
