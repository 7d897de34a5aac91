// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/burst_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

constexpr double kBin_s = 0.005;
constexpr std::int64_t kLength = 300;
constexpr std::int64_t kDrawn = 199;

/// A burst from `begin` that rises linearly over `rise` bins, to 100 times the power of rest.
struct Risen {
  std::vector<double> power, levels;

  Risen(double begin, double rise, std::uint64_t seed) {
    Random random(seed, 6);
    for (std::int64_t i = 0; i < kLength; ++i) {
      double mean = 0.0;
      for (int p = 0; p < 10; ++p) {
        const double after = static_cast<double>(i) + 0.1 * p + 0.05 - begin;
        const double share = after <= 0.0 ? 0.0 : std::min(1.0, after / std::max(1e-9, rise));
        mean += 0.1 * (1.0 + 100.0 * share * share);
      }
      const double a = random.gaussian(), b = random.gaussian();
      power.push_back(0.5 * mean * (a * a + b * b));
      levels.push_back(static_cast<double>(i) < std::floor(begin + 0.4 * rise) ? 1.0 : 101.0);
    }
  }
};

std::vector<double> onsets(const Risen& one, std::int64_t bin) {
  const std::vector<BurstEdge> edges{{.bin = bin, .quiet = 100, .burst = 120}};
  std::vector<double> out;
  for (const auto& draw : draw_edges(edges, one.power, one.levels, 1.0, 2.0, {1.0}, kBin_s, kDrawn, 1))
    out.push_back(draw.front());
  std::ranges::sort(out);
  return out;
}

TEST(BurstEdges, DrawsHoldAStepWithinABin) {
  int inside = 0;
  double width = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const double begin = 150.0 + 0.05 * static_cast<double>(seed);
    const auto found = onsets(Risen(begin, 0.0, seed), 150);
    inside += found[4] <= begin && begin <= found[194];
    width += (found[194] - found[4]) / 20.0;
  }
  EXPECT_GE(inside, 18);
  EXPECT_LT(width, 5.0);
}

TEST(BurstEdges, DrawsHoldTheBeginningOfARise) {
  int inside = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto found = onsets(Risen(140.3, 20.0, seed), 148);
    inside += found[4] <= 140.3 && 140.3 <= found[194];
  }
  EXPECT_GE(inside, 17);
}

TEST(BurstEdges, AnEndIsAnOnsetSeenFromBehind) {
  const Risen one(150.0, 0.0, 3);
  auto power = one.power, levels = one.levels;
  std::ranges::reverse(power), std::ranges::reverse(levels);
  const auto drawn = draw_edges({{.bin = 150, .is_onset = false, .quiet = 100, .burst = 120}}, power, levels,
                                1.0, 2.0, {1.0}, kBin_s, kDrawn, 1);
  const auto forward = draw_edges({{.bin = 150, .quiet = 100, .burst = 120}}, one.power, one.levels, 1.0, 2.0,
                                  {1.0}, kBin_s, kDrawn, 1);
  for (std::size_t d = 0; d < drawn.size(); ++d)
    EXPECT_NEAR(drawn[d].front(), static_cast<double>(kLength) - forward[d].front(), 1e-9);
}

TEST(BurstEdges, WhatTheFilterSpreadsBeginsNoEarlier) {
  Risen one(150.0, 0.0, 5);
  const auto before = onsets(one, 150);
  // A twentieth of the power comes out a bin earlier or later.
  const auto sharp = one.power;
  for (std::size_t i = 1; i + 1 < sharp.size(); ++i)
    one.power[i] = 0.05 * sharp[i - 1] + 0.9 * sharp[i] + 0.05 * sharp[i + 1];
  const auto blind = onsets(one, 150);
  std::vector<double> aware;
  for (const auto& draw : draw_edges({{.bin = 150, .quiet = 100, .burst = 120}}, one.power, one.levels, 1.0,
                                     2.0, {0.05, 0.9, 0.05}, kBin_s, kDrawn, 1))
    aware.push_back(draw.front());
  std::ranges::sort(aware);
  EXPECT_LT(blind[100], before[100]);
  EXPECT_GT(aware[100], blind[100]);
}

}  // namespace
}  // namespace kinemark::analysis
