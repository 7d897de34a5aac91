// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/power_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

constexpr double kSquares = 2.0;  // in a bin
constexpr std::int64_t kBins = 2000;

/// Bins whose power is the mean of two squares, of a strength.
template <typename F>
std::vector<double> bins_of(const F& power, std::uint64_t seed) {
  Random random(seed, 3);
  std::vector<double> out;
  for (std::int64_t i = 0; i < kBins; ++i) {
    const double a = random.gaussian(), b = random.gaussian();
    out.push_back(0.5 * power(static_cast<double>(i)) * (a * a + b * b));
  }
  return out;
}

Quiet quiet_of(const std::vector<double>& power) {
  double freedom = kSquares;
  const auto levels = power_levels(power, freedom);
  return find_quiet(power, levels, freedom, kSquares, {.rest = 100.0, .burst = 10.0, .judged = 50.0});
}

TEST(PowerLevels, AStepIsFoundWhereItIs) {
  double freedom = kSquares;
  const auto power = bins_of([](double i) { return i < 700.0 ? 1.0 : 9.0; }, 1);
  const auto levels = power_levels(power, freedom);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_NEAR(static_cast<double>(levels[1].first), 700.0, 4.0);
  EXPECT_NEAR(levels[0].power, 1.0, 0.15);
  EXPECT_NEAR(levels[1].power, 9.0, 1.0);
  EXPECT_EQ(levels[0].end, levels[1].first);
  EXPECT_EQ(levels[1].end, kBins);
}

TEST(PowerLevels, WhatScattersMoreThanGaussianNoiseHasFewerSquares) {
  // Strength of its own for each ten bins.
  Random random(4, 4);
  std::vector<double> strength;
  for (int k = 0; k < 200; ++k) strength.push_back(std::exp(0.3 * random.gaussian()));
  double freedom = kSquares;
  const auto levels = power_levels(
      bins_of([&](double i) { return strength[static_cast<std::size_t>(i / 10.0)]; }, 2), freedom);
  EXPECT_LT(freedom, 0.75 * kSquares);
  double even = kSquares;
  const auto one = power_levels(bins_of([](double) { return 1.0; }, 2), even);
  EXPECT_EQ(one.size(), 1u);
  EXPECT_GT(even, 0.8 * kSquares);
}

TEST(PowerLevels, ABurstIsActiveAndTheOthersAreRest) {
  const auto quiet = quiet_of(bins_of([](double i) { return i >= 500.0 && i < 900.0 ? 30.0 : 2.0; }, 3));
  EXPECT_EQ(quiet.found, Quiet::Found::bursts);
  EXPECT_NEAR(quiet.power, 2.0, 0.2);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(quiet.active, 1)), 400.0, 8.0);
}

TEST(PowerLevels, AShortBurstAndAShortInterruptionDoNotCount) {
  const auto quiet = quiet_of(bins_of(
      [](double i) {
        const bool knock = i >= 1500.0 && i < 1505.0, pause = i >= 700.0 && i < 705.0;
        return knock || (i >= 500.0 && i < 900.0 && !pause) ? 200.0 : 1.0;
      },
      4));
  EXPECT_EQ(quiet.active[702], 1);
  EXPECT_EQ(quiet.active[1502], 0);
}

TEST(PowerLevels, WithoutAStepNothingIsRestOrActive) {
  for (std::uint64_t seed = 10; seed < 30; ++seed)
    EXPECT_EQ(quiet_of(bins_of([](double) { return 5.0; }, seed)).found, Quiet::Found::steady) << seed;
}

TEST(PowerLevels, AStrengthThatIsNeverLowForLongHasNoRest) {
  const auto modulated = [](double i) {
    return std::exp(2.0 * std::sin(2.0 * std::numbers::pi * i / 400.0) +
                    std::sin(2.0 * std::numbers::pi * i / 270.0 + 1.0));
  };
  EXPECT_NE(quiet_of(bins_of(modulated, 5)).found, Quiet::Found::bursts);
  const auto valleys = [](double i) {
    return std::pow(1.0 + 0.7 * std::sin(2.0 * std::numbers::pi * i / 300.0), 2);
  };
  EXPECT_NE(quiet_of(bins_of(valleys, 6)).found, Quiet::Found::bursts);
}

TEST(PowerLevels, QuietPartsThatAreTooShortTellNoRest) {
  for (const double quiet : {40.0, 60.0}) {
    const auto pulses = [quiet](double i) { return std::fmod(i, 100.0) < quiet ? 1.0 : 30.0; };
    EXPECT_EQ(quiet_of(bins_of(pulses, 8)).found, quiet < 50.0 ? Quiet::Found::no_rest : Quiet::Found::bursts)
        << quiet;
  }
}

TEST(PowerLevels, OneLevelWhoseBinsScatterIsModulatedAndNotSteady) {
  const auto fast = [](double i) { return std::pow(0.55 + 0.45 * std::sin(0.2 * std::numbers::pi * i), 2); };
  for (std::uint64_t seed = 10; seed < 20; ++seed)
    EXPECT_EQ(quiet_of(bins_of(fast, seed)).found, Quiet::Found::no_rest) << seed;
}

}  // namespace
}  // namespace kinemark::analysis
