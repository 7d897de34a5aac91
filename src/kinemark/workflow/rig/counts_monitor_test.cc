// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/counts_monitor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/rig_recording.h"

namespace kinemark::workflow {
namespace {

data::Counts layout(bool dark) {
  return data::Counts::zeros({"hand", "elbow"}, {"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 0},
                             dark);
}

// Counts of a frame: every channel of LED l in camera c has `base(l, c)`, plus what `extra` gives.
template <class Extra>
void push(CountsMonitor& monitor, std::int64_t number, const Extra& extra,
          std::vector<std::uint8_t> flags = {0, 0, 0, 0}, std::vector<std::int16_t> dark = {}) {
  std::vector<std::int16_t> counts;
  for (int o = 0; o < 4; ++o)
    for (int k = 0; k < 4; ++k) counts.push_back(static_cast<std::int16_t>(extra(o, k)));
  monitor.push(number, counts, flags, dark);
}

TEST(CountsMonitor, KnowsNothingBeforeTheFirstFrame) {
  const CountsMonitor monitor(layout(false));
  const LedInCamera seen = monitor.seen(0, 0);
  EXPECT_TRUE(std::isnan(seen.light_counts) && std::isnan(seen.noise_counts) && std::isnan(seen.spot.x()));
  EXPECT_EQ(seen.occluded_share, 0.0);
  EXPECT_TRUE(monitor.spots(0, 0).empty());
}

TEST(CountsMonitor, SpotsAreTheRatiosOfTheChannelsAboveTheDarkSlot) {
  CountsMonitor monitor(layout(true));
  push(
      monitor, 0,
      [](int o, int k) {
        return 20 + (o == 0 ? std::array{900, 300, 200, 600}[static_cast<std::size_t>(k)] : 500);
      },
      {0, 0, 0, 0}, std::vector<std::int16_t>(8, 20));
  const LedInCamera seen = monitor.seen(0, 0);
  EXPECT_NEAR(seen.spot.x(), 0.5, 1e-12);
  EXPECT_NEAR(seen.spot.y(), -0.5, 1e-12);
  EXPECT_NEAR(seen.light_counts, 2000.0, 1e-12);
  EXPECT_NEAR(seen.highest_share, 920.0 / 4095.0, 1e-12);
  ASSERT_EQ(monitor.spots(0, 0).size(), 1U);
}

TEST(CountsMonitor, NoiseIsThatOfAChannelWhateverMoves) {
  CountsMonitor monitor(layout(false), 2000);
  Random random(7, 0);
  for (int f = 0; f < 2000; ++f)
    push(monitor, f, [&](int o, int) {
      const double path = o == 0 ? 1000.0 + 0.0001 * f * f : 1000.0;  // accelerates
      return std::lround(path + 3.0 * random.gaussian());
    });
  // Rounding adds 1/12 to the variance; 8000 differences of which neighbours share samples: 2 %.
  EXPECT_NEAR(monitor.seen(0, 0).noise_counts, std::sqrt(9.0 + 1.0 / 12.0), 0.1);
  EXPECT_NEAR(monitor.seen(1, 1).noise_counts, std::sqrt(9.0 + 1.0 / 12.0), 0.1);
}

TEST(CountsMonitor, FramesThatAreMissingAreNoNoise) {
  CountsMonitor monitor(layout(false));
  for (const int f : {0, 1, 2, 5, 6, 7}) push(monitor, f, [&](int, int) { return f < 3 ? 500 : 900; });
  EXPECT_EQ(monitor.frames(), 6);
  EXPECT_TRUE(std::isnan(monitor.seen(0, 0).noise_counts));  // no four frames in a row
  push(monitor, 8, [](int, int) { return 900; });
  EXPECT_EQ(monitor.seen(0, 0).noise_counts, 0.0);  // the jump across the gap is none of noise
}

TEST(CountsMonitor, OccludedAndSaturatedSharesAreOfTheLastFrames) {
  CountsMonitor monitor(layout(false), 4);
  for (int f = 0; f < 4; ++f) push(monitor, f, [](int, int) { return 5; });
  EXPECT_EQ(monitor.seen(0, 0).occluded_share, 1.0);
  push(monitor, 4, [](int, int) { return 4095; }, {data::kCountSaturated, 0, data::kCountOccluded, 0});
  EXPECT_EQ(monitor.seen(0, 0).occluded_share, 0.75);
  EXPECT_EQ(monitor.seen(0, 0).saturated_share, 0.25);
  EXPECT_EQ(monitor.seen(1, 0).occluded_share, 1.0);
  EXPECT_EQ(monitor.seen(0, 1).saturated_share, 0.0);
}

TEST(CountsMonitor, FindsTheNoiseOfTheSimulatedRig) {
  const auto rig = simulation::draw_rig();
  ASSERT_TRUE(rig);
  simulation::RigRecordingOptions still;
  still.frames = 400;
  const auto recorded =
      simulation::record(*rig, simulation::still_tree(simulation::tree_test_poses()[0]), still);
  ASSERT_TRUE(recorded) << recorded.error().message;
  const data::Counts& counts = recorded->counts;
  CountsMonitor monitor(counts, 400);
  const auto observations = static_cast<std::size_t>(counts.led_count() * counts.camera_count());
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    monitor.push(
        f, std::span(counts.counts).subspan(static_cast<std::size_t>(f) * 4 * observations, 4 * observations),
        std::span(counts.flags).subspan(static_cast<std::size_t>(f) * observations, observations), {});
  // Against the plain standard deviation of a channel at rest, flicker of 1 count and noise together.
  double sum = 0.0, squares = 0.0;
  for (std::int64_t f = 0; f < counts.frames(); ++f) {
    sum += counts.at(f, 1, 0)(2);
    squares += counts.at(f, 1, 0)(2) * counts.at(f, 1, 0)(2);
  }
  const double n = static_cast<double>(counts.frames());
  EXPECT_NEAR(monitor.seen(1, 0).noise_counts, std::sqrt(squares / n - sum * sum / n / n), 0.6);
  EXPECT_LT(monitor.seen(1, 0).spot.norm(), 1.0);
}

}  // namespace
}  // namespace kinemark::workflow
