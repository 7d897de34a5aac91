// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/count_check.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::stream {
namespace {

data::Counts layout(bool dark = false) {
  return data::Counts::zeros({"still", "moves"}, {"A", "B"}, {.rate_hz = 100.0, .frames = 0}, dark);
}

/// An LED that stands still and one that swings, with noise of SD 3 counts.
Block some(std::int64_t first, std::int64_t frames, bool dark = false) {
  Block out{.first_frame = first, .frames = frames};
  Random random(4, static_cast<std::uint64_t>(first));
  for (std::int64_t f = first; f < first + frames; ++f) {
    for (int led = 0; led < 2; ++led)
      for (int channel = 0; channel < 8; ++channel) {
        const double swing = led == 0 ? 0.0 : 200.0 * std::sin(0.05 * static_cast<double>(f));
        out.counts.push_back(
            static_cast<std::int16_t>(std::lround(1000.0 + 10 * channel + swing + 3.0 * random.gaussian())));
      }
    for (int channel = 0; dark && channel < 8; ++channel) out.dark.push_back(16);
  }
  out.flags.assign(static_cast<std::size_t>(4 * frames), 0);
  return out;
}

TEST(CountCheck, TellsNoiseFromMovement) {
  CountCheck check(layout());
  for (std::int64_t f = 0; f < 4000; f += 100) check.add(some(f, 100));
  const auto lit = check.lit();
  ASSERT_EQ(lit.size(), 4U);
  EXPECT_EQ(lit[0].frames, 4000);
  EXPECT_TRUE(lit[0].still && lit[1].still);
  EXPECT_FALSE(lit[2].still || lit[3].still);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(lit[1].mean[k], 1040.0 + 10 * k, 0.2);
    EXPECT_NEAR(lit[0].sd[k], 3.0, 0.15);
    EXPECT_NEAR(lit[0].noise[k], 3.0, 0.15);
    EXPECT_NEAR(lit[2].sd[k], 141.0, 3.0);
    EXPECT_LT(lit[2].noise[k], 8.0);
  }
  EXPECT_TRUE(check.dark().empty());
}

TEST(CountCheck, DifferencesAreOfFramesThatFollowEachOther) {
  CountCheck check(layout());
  // Every second frame is missing: no difference is taken.
  for (std::int64_t f = 0; f < 20; f += 2) check.add(some(f, 1));
  EXPECT_TRUE(std::isnan(check.lit()[0].noise[0]));
  EXPECT_FALSE(std::isnan(check.lit()[0].sd[0]));
  EXPECT_FALSE(check.lit()[0].still);
}

TEST(CountCheck, CountsWhatIsSaturatedAndLeavesOutWhatIsLost) {
  CountCheck check(layout());
  auto block = some(0, 3);
  block.flags[0] = data::kCountSaturated;
  block.flags[4] = data::kCountLost;
  check.add(block);
  EXPECT_EQ(check.lit()[0].frames, 2);
  EXPECT_EQ(check.lit()[0].saturated, 1);
  EXPECT_EQ(check.lit()[1].saturated, 0);
}

TEST(CountCheck, HasTheDarkSlotOfEachCamera) {
  CountCheck check(layout(true));
  check.add(some(0, 10, true));
  ASSERT_EQ(check.dark().size(), 2U);
  EXPECT_EQ(check.dark()[1].mean[3], 16.0);
  EXPECT_EQ(check.dark()[1].noise[3], 0.0);
  EXPECT_TRUE(std::isnan(CountCheck(layout()).lit()[0].mean[0]));
}

TEST(DifferenceNoise, IsNoneOfAPathOfConstantAcceleration) {
  DifferenceNoise noise;
  EXPECT_TRUE(std::isnan(noise.sd()(0)));
  for (int f = 0; f < 100; ++f) noise.add(f, Eigen::Vector4d::Constant(3.0 + 2.0 * f + 0.5 * f * f));
  EXPECT_LT(noise.sd().maxCoeff(), 1e-9);
}

TEST(DifferenceNoise, IsNotTakenAcrossAGap) {
  DifferenceNoise noise;
  for (const int f : {0, 1, 2, 10, 11, 12}) noise.add(f, Eigen::Vector4d::Constant(f < 5 ? 0.0 : 1000.0));
  EXPECT_TRUE(std::isnan(noise.sd()(0)));
  noise.add(13, Eigen::Vector4d::Constant(1000.0));
  EXPECT_EQ(noise.sd()(0), 0.0);
}

TEST(DifferenceNoise, IsTheStandardDeviationOfWhiteNoise) {
  DifferenceNoise noise;
  Random random(4, 0);
  for (int f = 0; f < 20'000; ++f)
    noise.add(
        f, 5.0 * Eigen::Vector4d(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian()));
  EXPECT_NEAR(noise.sd().mean(), 5.0, 0.1);
}

}  // namespace
}  // namespace kinemark::stream
