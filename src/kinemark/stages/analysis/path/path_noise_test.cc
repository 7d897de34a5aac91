// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/low_pass.h"
#include "kinemark/stages/analysis/path/testing/known_noise.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using math::LowPass;
using math::NoiseKind;
using math::NoiseModel;
using testing::all_seen;
using testing::cycles_with;
using testing::kSamples;
using testing::noise_of;
using testing::quintic;
using testing::slow;
using testing::white;

TEST(FindPathNoise, OfWhiteNoiseIsWhite) {
  const auto noise = noise_of(cycles_with(white(5e-4), 1));
  EXPECT_EQ(noise.source, NoiseSource::spectrum);
  EXPECT_EQ(noise.model.kind, NoiseKind::white);
  EXPECT_NEAR(noise.sd_m(), 5e-4, 6e-5);
  EXPECT_FALSE(noise.slow_is_unknown());
  EXPECT_EQ(noise.draws.size(), 99u);
}

TEST(FindPathNoise, AFilterHasItsCutOffAndTheNoiseBeforeIt) {
  const auto noise = noise_of(cycles_with(quintic(5e-4, 7.0), 2));
  ASSERT_TRUE(noise.filtered());
  const double truth = 100.0 * math::three_db_of_half(LowPass::spline, 3, 0.07);
  EXPECT_LT(noise.cutoff_hz.low, truth * 1.05);
  EXPECT_GT(noise.cutoff_hz.high, truth * 0.95);
  EXPECT_NEAR(std::log(noise.sd_m() / 5e-4), 0.0, 0.6);
}

TEST(FindPathNoise, SlowNoiseIsCalledSoAndItsSizeUnknown) {
  const auto noise = noise_of(cycles_with(slow(1e-3, 0.99), 3));
  EXPECT_GT(noise.model.correlation, 0.6);
  EXPECT_TRUE(noise.slow_is_unknown());
}

TEST(FindPathNoise, StatedNoiseKeepsTheFormAndScales) {
  const auto noise = noise_of(cycles_with(slow(1e-3, 0.9), 3), {.stated_sd_m = 1e-3});
  EXPECT_EQ(noise.source, NoiseSource::stated);
  EXPECT_NE(noise.model.kind, NoiseKind::white);
  EXPECT_NEAR(noise.sd_m(), 1e-3, 1e-6);
  for (const auto& draw : noise.draws) EXPECT_NEAR(draw.sd(true), 1e-3, 1e-6);
  const auto filtered = noise_of(cycles_with(quintic(5e-4, 7.0), 2), {.stated_sd_m = 4.5e-4});
  EXPECT_TRUE(filtered.filtered());
  EXPECT_NEAR(std::sqrt(filtered.model.variance), 4.5e-4, 1e-6);
}

TEST(FindPathNoise, OfStatedAndFoundNoiseTheLargerCounts) {
  const auto agrees = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 5.5e-4});
  EXPECT_NEAR(agrees.sd_m(), 5.5e-4, 1e-6);
  const auto less = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 1e-4});
  EXPECT_NEAR(less.sd_m(), 5e-4, 6e-5);
  const auto more = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 1e-3});
  EXPECT_NEAR(more.sd_m(), 1e-3, 1e-6);
}

TEST(FindPathNoise, NoiseBelowTheRoundingOfTheFileIsNoNoise) {
  SeriesMatrix x = testing::drifting_cycles_with(white(2e-6), 5), finer = x;
  for (auto& value : x.reshaped()) value = 7.4e-5 * std::round(value / 7.4e-5);
  for (auto& value : finer.reshaped()) value = 1e-7 * std::round(value / 1e-7);
  const auto rounded = noise_of(x);
  EXPECT_EQ(rounded.source, NoiseSource::rounding);
  EXPECT_TRUE(rounded.unusable());
  EXPECT_NEAR(rounded.rounding_step_m, 7.4e-5, 1e-9);
  const auto noise = noise_of(finer);
  EXPECT_EQ(noise.source, NoiseSource::spectrum);
  EXPECT_FALSE(noise.unusable());
}

TEST(FindPathNoise, WhatFitsNoModelHasNoInterval) {
  SeriesMatrix x = cycles_with(white(1e-4), 6);
  for (std::int64_t i = 0; i < kSamples; ++i)
    x.row(i).array() += 2e-3 * (std::sin(testing::kTurn * 0.30 * static_cast<double>(i)) +
                                std::sin(testing::kTurn * 0.44 * static_cast<double>(i)));
  const auto noise = noise_of(x);
  EXPECT_EQ(noise.source, NoiseSource::no_model);
  EXPECT_TRUE(noise.unusable());
}

TEST(FindPathNoise, AFilterThatIsStatedIsTakenWithItsNoise) {
  const double down = 100.0 * math::three_db_of_half(LowPass::spline, 4, 0.08);
  const data::FilterUsed used{.method = "kalman", .order = 4, .cutoff_hz = down, .noise_sd_m = 4e-4};
  const NoiseModel model{
      .kind = NoiseKind::filtered, .form = LowPass::spline, .order = 4, .variance = 1.6e-7, .half = 0.08};
  const auto noise = noise_of(cycles_with(model, 7), {.filter = &used});
  EXPECT_EQ(noise.source, NoiseSource::filter);
  EXPECT_EQ(noise.model.order, 4);
  EXPECT_NEAR(noise.model.half, 0.08, 0.004);
  EXPECT_NEAR(noise.sd_m(), 4e-4, 1e-4);
  const data::FilterUsed other{.method = "savgol", .order = 3, .cutoff_hz = 8.0};
  EXPECT_FALSE(low_pass_of(other, 100.0));
  EXPECT_FALSE(low_pass_of({.method = "kalman", .order = 4, .cutoff_hz = kNaN}, 100.0));
}

TEST(FindPathNoise, ShortRecordingsAreTakenAsWhite) {
  const SeriesMatrix x = cycles_with(white(5e-4), 8).topRows(40);
  const auto noise = find_path_noise(x, std::vector<bool>(40, true), 100.0, {.draws = 5});
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->source, NoiseSource::too_short);
  EXPECT_EQ(noise->draws.size(), 5u);
  const SeriesMatrix still = SeriesMatrix::Zero(40, 3);
  EXPECT_FALSE(find_path_noise(still, std::vector<bool>(40, true), 100.0, {}));
}

TEST(SingleFrameOutliers, AreSpikesAndNotMovement) {
  SeriesMatrix x = cycles_with(white(3e-4), 9);
  EXPECT_EQ(std::ranges::count(single_frame_outliers(x, all_seen()), true), 0);
  for (const std::int64_t i : {50, 200, 333}) x(i, 1) += 5e-3;
  const auto found = single_frame_outliers(x, all_seen());
  EXPECT_EQ(std::ranges::count(found, true), 3);
  for (const std::size_t i : {50u, 200u, 333u}) EXPECT_TRUE(found[i]);
  // A filtered reach: at rest nothing, in movement large and smooth residuals.
  SeriesMatrix smooth =
      testing::sampled(kSamples, 100.0, testing::reach) + noise_before_filter(white(2e-4), kSamples, 3, 1, 1);
  LowPassFilter(quintic(2e-4, 8.0), kSamples).apply(smooth);
  EXPECT_EQ(std::ranges::count(single_frame_outliers(smooth, all_seen()), true), 0);
}

TEST(WithoutSpikes, LeavesOutPairsOfSpikesAndKeepsTheRest) {
  auto x = cycles_with(white(5e-4), 6);
  EXPECT_EQ(std::ranges::count(without_spikes(x, all_seen()), false), 0);
  x.row(100).array() += 0.03, x.row(101).array() += 0.012, x.row(300).array() -= 0.02;
  const auto left = without_spikes(x, all_seen());
  // A good sample beside a pair may go with it.
  EXPECT_LE(std::ranges::count(left, false), 4);
  EXPECT_FALSE(left[100] || left[101] || left[300]);
}

// Student's t of three degrees of freedom: one recording of twenty was called correlated while all beyond 5.5
// deviations was left out.
TEST(WithoutSpikes, LeavesNoiseWithHeavyTailsWhite) {
  int correlated = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed, 5);
    auto x = cycles_with(white(1e-5), seed);
    for (auto& value : x.reshaped()) {
      double squares = 0.0;
      for (int i = 0; i < 3; ++i) squares += std::pow(random.gaussian(), 2);
      value += 5e-4 * random.gaussian() / std::sqrt(squares);
    }
    const auto noise = find_path_noise(x, without_spikes(x, all_seen()), 100.0, {.draws = 1});
    ASSERT_TRUE(noise);
    correlated += noise->model.kind != NoiseKind::white;
  }
  EXPECT_LE(correlated, 2);
}

TEST(RoundingStep, IsFoundWhereThereIsOne) {
  SeriesMatrix x = testing::sampled(kSamples, 100.0, testing::ellipse);
  Random random(3, 3);
  for (auto& value : x.reshaped()) value += 1e-4 * random.gaussian();
  EXPECT_EQ(rounding_step(x, all_seen()), 0.0);
  for (auto& value : x.reshaped()) value = 5e-5 * std::round(value / 5e-5);
  EXPECT_NEAR(rounding_step(x, all_seen()), 5e-5, 1e-9);
}

}  // namespace
}  // namespace kinemark::analysis
