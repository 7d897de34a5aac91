// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/slot_crosstalk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::stream {
namespace {

// Two LEDs at two cameras; the dark slot after the second, or before the first.
data::Counts two_leds(bool dark_first) {
  auto out = data::Counts::zeros({"a", "b"}, {"A", "B"}, {.rate_hz = 100.0}, true);
  for (std::size_t i = 0; i < out.conversion_time_s.size(); ++i)
    out.conversion_time_s[i] = (i < 8 ? 1e-3 : 2e-3) + 1e-5 * static_cast<double>(i % 8);
  std::ranges::fill(out.dark_time_s, dark_first ? 0.0 : 3e-3);
  return out;
}

struct Made {
  int frames = 2000;
  double movement = 300.0;  // amplitude of LED b's counts, in a cycle of 37 frames
  double share = 0.0;       // of LED b that is left in the dark slot
  double flicker = 0.0;     // that both slots have in common, counts
  bool dark_first = false;
  std::uint64_t seed = 1;
};

SlotCrosstalk of(const Made& made) {
  SlotCrosstalk out(two_leds(made.dark_first));
  Random random(made.seed, 0);
  Block block;
  block.frames = 1;
  block.counts.resize(16);
  block.dark.resize(8);
  block.flags.assign(4, 0);
  std::vector<double> before(8, 1000.0);
  for (int f = 0; f < made.frames; ++f) {
    block.first_frame = f;
    const double flicker = made.flicker * std::sin(1.7 * f), drift = 0.01 * f;
    const double moved = 1000.0 + made.movement * std::sin(2.0 * f * 3.14159 / 37.0);
    for (std::size_t i = 0; i < 16; ++i)
      block.counts[i] = static_cast<std::int16_t>(std::lround(
          (i < 8 ? 500.0 + 200.0 * std::cos(0.3 * f) : moved) + flicker + drift + random.gaussian()));
    for (std::size_t i = 0; i < 8; ++i) {
      const double light = made.dark_first ? before[i] : block.counts[8 + i];
      block.dark[i] = static_cast<std::int16_t>(
          std::lround(16.0 + flicker + drift + made.share * light + random.gaussian()));
      before[i] = block.counts[8 + i];
    }
    out.add(block);
  }
  return out;
}

TEST(SlotCrosstalk, IsFoundWithItsDeviation) {
  for (const bool dark_first : {false, true})
    for (const double share : {0.002, 0.03}) {
      const auto crosstalk = of({.share = share, .dark_first = dark_first});
      EXPECT_EQ(crosstalk.led(), 1);
      ASSERT_EQ(crosstalk.found().size(), 2U);
      for (const auto& camera : crosstalk.found())
        for (int k = 0; k < 4; ++k) {
          EXPECT_NEAR(camera.share(k), share, 4.0 * camera.sd(k)) << share;
          EXPECT_LT(camera.sd(k), 4e-4);
        }
    }
}

TEST(SlotCrosstalk, OfNoneIsWithinItsDeviation) {
  int within = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    for (const auto& camera : of({.seed = seed}).found())
      for (int k = 0; k < 4; ++k, ++all) {
        within += std::abs(camera.share(k)) <= camera.sd(k);
        EXPECT_LE(std::abs(camera.share(k)), 4.0 * camera.sd(k));
      }
  EXPECT_GE(within, all * 6 / 10);
}

TEST(SlotCrosstalk, LightOfTheRoomIsNotTakenForIt) {
  const auto still = of({.movement = 0.0, .flicker = 2.0});
  EXPECT_GT(still.found()[0].sd.minCoeff(), 0.2) << "an LED that stands still says nothing";
  for (const auto& camera : of({.flicker = 2.0}).found())
    for (int k = 0; k < 4; ++k) EXPECT_LE(std::abs(camera.share(k)), 4.0 * camera.sd(k));
}

TEST(SlotCrosstalk, NeedsADarkSlotAndFrames) {
  EXPECT_TRUE(std::isnan(of({.frames = 300}).found()[0].share(0)));
  auto without = data::Counts::zeros({"a"}, {"A"}, {.rate_hz = 100.0}, false);
  SlotCrosstalk none(without);
  none.add({.frames = 1, .counts = {1, 1, 1, 1}, .dark = {}, .flags = {0}});
  EXPECT_TRUE(none.found().empty());
  EXPECT_EQ(none.led(), -1);
}

TEST(SlotCrosstalk, FramesThatAreLostAreLeftOut) {
  SlotCrosstalk crosstalk(two_leds(false));
  Block block{.frames = 1};
  block.counts.assign(16, 0);
  block.dark.assign(8, 0);
  for (int f = 0; f < 1000; ++f) {
    block.first_frame = f;
    const bool lost = f % 2 == 1;
    block.flags.assign(4, lost ? data::kCountLost : 0);
    std::ranges::fill(block.counts, static_cast<std::int16_t>(lost ? 0 : 1000 + f % 40));
    std::ranges::fill(block.dark, static_cast<std::int16_t>(lost ? 500 : 16));
    crosstalk.add(block);
  }
  EXPECT_EQ(crosstalk.found()[0].share(0), 0.0);
}

}  // namespace
}  // namespace kinemark::stream
