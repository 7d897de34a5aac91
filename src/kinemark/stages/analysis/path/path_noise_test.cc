// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/low_pass.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using math::LowPass;
using math::NoiseKind;
using math::NoiseModel;

constexpr std::int64_t kSamples = 500;

std::vector<bool> all_seen() { return std::vector<bool>(kSamples, true); }

SeriesMatrix cycles_with(const NoiseModel& model, std::uint64_t seed) {
  SeriesMatrix x =
      testing::sampled(kSamples, 100.0, testing::ellipse) + noise_before_filter(model, kSamples, 3, seed, 4);
  if (model.order > 0) LowPassFilter(model, kSamples).apply(x);
  for (auto& value : x.reshaped()) value = 1e-3 * static_cast<double>(static_cast<float>(1e3 * value));
  return x;
}

NoiseModel white(double sd) { return {.variance = sd * sd}; }
NoiseModel slow(double sd, double rho) {
  return {.kind = NoiseKind::correlated, .variance = sd * sd, .correlation = rho};
}
NoiseModel quintic(double sd, double half_hz) {
  return {.kind = NoiseKind::filtered,
          .form = LowPass::spline,
          .order = 3,
          .variance = sd * sd,
          .half = half_hz / 100.0};
}

PathNoise noise_of(const SeriesMatrix& x, const NoiseKnown& known = {}) {
  auto found = find_path_noise(x, all_seen(), 100.0, known);
  if (!found) throw std::runtime_error("no noise");
  found->subject = "KNE";
  return *found;
}

std::string said(const PathNoise& noise) {
  std::string out;
  for (const auto& sentence : noise_sentences({&noise, 1})) out += sentence + "\n";
  return out;
}

TEST(FindPathNoise, OfWhiteNoiseNothingNeedsToBeSaid) {
  const auto noise = noise_of(cycles_with(white(5e-4), 1));
  EXPECT_EQ(noise.source, NoiseSource::spectrum);
  EXPECT_EQ(noise.model.kind, NoiseKind::white);
  EXPECT_NEAR(noise.sd_m(), 5e-4, 6e-5);
  EXPECT_FALSE(noise.slow_is_unknown());
  EXPECT_EQ(noise.draws.size(), 99u);
  EXPECT_EQ(said(noise), "");
}

TEST(FindPathNoise, AFilterIsNamedWithItsCutOffAndTheNoiseBeforeIt) {
  const auto noise = noise_of(cycles_with(quintic(5e-4, 7.0), 2));
  ASSERT_TRUE(noise.filtered());
  const double truth = 100.0 * math::three_db_of_half(LowPass::spline, 3, 0.07);
  EXPECT_LT(noise.cutoff_hz.low, truth * 1.05);
  EXPECT_GT(noise.cutoff_hz.high, truth * 0.95);
  EXPECT_NEAR(std::log(noise.sd_m() / 5e-4), 0.0, 0.6);
  const auto text = said(noise);
  EXPECT_NE(text.find("KNE was low-passed at about "), std::string::npos) << text;
  EXPECT_NE(text.find("quintic spline"), std::string::npos) << text;
  EXPECT_NE(text.find("noise before that"), std::string::npos) << text;
  EXPECT_EQ(text.find("correlated"), std::string::npos) << text;
}

TEST(FindPathNoise, SlowNoiseIsCalledSoAndItsSizeUnknown) {
  const auto noise = noise_of(cycles_with(slow(1e-3, 0.99), 3));
  EXPECT_GT(noise.model.correlation, 0.6);
  EXPECT_TRUE(noise.slow_is_unknown());
  const auto text = said(noise);
  EXPECT_NE(text.find("correlated over"), std::string::npos) << text;
  EXPECT_NE(text.find("the noise below 2 Hz cannot be told from movement (between "), std::string::npos)
      << text;
  EXPECT_EQ(text.find("low-passed"), std::string::npos) << text;
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

TEST(FindPathNoise, StatedNoiseThatTheSamplesContradictIsReportedAndTheLargerCounts) {
  const auto agrees = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 5.5e-4});
  EXPECT_EQ(said(agrees), "");
  const auto less = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 1e-4});
  EXPECT_NE(said(less).find("not the 0.1 mm that were stated"), std::string::npos) << said(less);
  EXPECT_NEAR(less.sd_m(), 5e-4, 6e-5);
  const auto more = noise_of(cycles_with(white(5e-4), 1), {.stated_sd_m = 1e-3});
  EXPECT_NE(said(more).find("not the 1 mm that were stated"), std::string::npos) << said(more);
  EXPECT_NEAR(more.sd_m(), 1e-3, 1e-6);
}

TEST(FindPathNoise, NoiseBelowTheRoundingOfTheFileIsNoNoise) {
  SeriesMatrix x = cycles_with(white(2e-6), 5), finer = x;
  for (auto& value : x.reshaped()) value = 7.4e-5 * std::round(value / 7.4e-5);
  for (auto& value : finer.reshaped()) value = 1e-7 * std::round(value / 1e-7);
  const auto rounded = noise_of(x);
  EXPECT_EQ(rounded.source, NoiseSource::rounding);
  EXPECT_TRUE(rounded.unusable());
  EXPECT_NE(said(rounded).find("below the rounding of the file (0.074 mm)"), std::string::npos)
      << said(rounded);
  const auto noise = noise_of(finer);
  EXPECT_EQ(noise.source, NoiseSource::spectrum);
  EXPECT_EQ(said(noise), "");
}

TEST(FindPathNoise, WhatFitsNoModelHasNoInterval) {
  SeriesMatrix x = cycles_with(white(1e-4), 6);
  for (std::int64_t i = 0; i < kSamples; ++i)
    x.row(i).array() += 2e-3 * (std::sin(testing::kTurn * 0.30 * static_cast<double>(i)) +
                                std::sin(testing::kTurn * 0.44 * static_cast<double>(i)));
  const auto noise = noise_of(x);
  EXPECT_EQ(noise.source, NoiseSource::no_model);
  EXPECT_NE(said(noise).find("fits no model"), std::string::npos);
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

TEST(RoundingStep, IsFoundWhereThereIsOne) {
  SeriesMatrix x = testing::sampled(kSamples, 100.0, testing::ellipse);
  Random random(3, 3);
  for (auto& value : x.reshaped()) value += 1e-4 * random.gaussian();
  EXPECT_EQ(rounding_step(x, all_seen()), 0.0);
  for (auto& value : x.reshaped()) value = 5e-5 * std::round(value / 5e-5);
  EXPECT_NEAR(rounding_step(x, all_seen()), 5e-5, 1e-9);
}

TEST(NoiseSentences, MarkersThatSayTheSameAreNamedTogether) {
  auto one = noise_of(cycles_with(quintic(5e-4, 7.0), 2)), two = one,
       raw = noise_of(cycles_with(white(5e-4), 1));
  two.subject = "ANK";
  raw.subject = "TOE";
  const std::vector<PathNoise> markers{one, two, raw};
  const auto sentences = noise_sentences(markers);
  ASSERT_EQ(sentences.size(), one.slow_is_unknown() ? 2u : 1u);
  EXPECT_TRUE(sentences[0].starts_with("2 markers (KNE, ANK) were low-passed at about")) << sentences[0];
  EXPECT_EQ(sentences[0].find("TOE"), std::string::npos);
}

}  // namespace
}  // namespace kinemark::analysis
