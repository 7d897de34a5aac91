// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/rig_timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// As the rig of 1986 converts: LEDs in turn, cameras one after the other, a dark slot at the end if there is
// one.
data::Counts layout(std::vector<std::string> leds, const data::SlotTiming& timing) {
  auto out = data::Counts::zeros(std::move(leds), {"A", "B"}, {.rate_hz = 100.0}, timing.dark_slot);
  const int L = static_cast<int>(out.led_count());
  for (int led = 0; led <= L; ++led)
    for (int i = 0; i < 8; ++i) {
      auto& times = led < L ? out.conversion_time_s : out.dark_time_s;
      if (led < L || timing.dark_slot)
        times[static_cast<std::size_t>(led < L ? 8 * led + i : i)] =
            timing.conversion_offset_s(led, i / 4, i % 4, 2);
    }
  return out;
}

std::vector<std::string> texts_of(const TimingDiagram& diagram) {
  std::vector<std::string> out;
  for (const auto& span : diagram.spans) out.push_back(span.text);
  return out;
}

TEST(RigSchedule, HasALedLitUntilItsLastConversionHasEnded) {
  const data::SlotTiming timing;
  const auto slots = schedule_of(layout({"hand", "wrist", "elbow"}, timing), timing);
  ASSERT_EQ(slots.size(), 3U);
  for (int led = 0; led < 3; ++led) {
    const auto& slot = slots[static_cast<std::size_t>(led)];
    EXPECT_NEAR(slot.on_s, led * timing.slot_s(2), 1e-12);
    EXPECT_NEAR(slot.off_s, (led + 1) * timing.slot_s(2) - timing.off_s, 1e-12);
    EXPECT_EQ(slot.conversion_s.size(), 8U);
  }
  EXPECT_EQ(slots.back().led, "elbow");
}

TEST(PulseTrain, RisesAndFallsWhereThePulsesDo) {
  const auto train = pulse_train({{0.1, 0.3}, {0.5, 0.9}, {1.2, 1.4}}, 0.0, 0.8);
  const Eigen::VectorXd time = (Eigen::VectorXd(8) << 0.0, 0.1, 0.1, 0.3, 0.3, 0.5, 0.5, 0.8).finished(),
                        level = (Eigen::VectorXd(8) << 0, 0, 1, 1, 0, 0, 1, 1).finished();
  EXPECT_EQ(train.time, time);
  EXPECT_EQ(train.level, level);
}

TEST(FrameTiming, HasEveryPulseAndConversion) {
  const data::SlotTiming timing;
  const auto diagram = frame_timing(layout({"hand", "wrist"}, timing), timing, {1.0, 0.25});
  ASSERT_EQ(diagram.traces.size(), 4U) << "clock, LEDs, conversions";
  EXPECT_EQ(diagram.traces[2].name, "LED 2, wrist");
  EXPECT_EQ(diagram.traces[1].level.maxCoeff(), 1.0);
  EXPECT_EQ(diagram.traces[2].level.maxCoeff(), 0.25);
  EXPECT_NEAR(diagram.traces[2].time[1], 1e3 * timing.slot_s(2), 1e-9);
  EXPECT_THAT(texts_of(diagram), ElementsAre("slot 904 µs", "frame 10 ms"));
  // A corner at each end, and four for each of 16 conversions and of those of the next frame that are still
  // shown.
  EXPECT_EQ(diagram.traces[3].time.size() % 4, 2);
  EXPECT_GT(diagram.traces[3].time.size(), 2 + 4 * 16);
}

TEST(FrameTiming, NamesTheDarkSlotWhereThereIsOne) {
  data::SlotTiming timing;
  timing.dark_slot = true;
  const auto diagram = frame_timing(layout({"hand"}, timing), timing);
  EXPECT_THAT(texts_of(diagram), ElementsAre("slot 904 µs", "dark", "frame 10 ms"));
  EXPECT_NEAR(diagram.spans[1].from, 1e3 * timing.conversion_offset_s(1, 0, 0, 2), 1e-9);
}

TEST(SlotTiming, IsDrawnWithAndWithoutAnAmplifier) {
  const data::SlotTiming timing;
  const auto slots = schedule_of(layout({"hand", "wrist"}, timing), timing);
  const auto diagram = slot_timing(slots[1], timing, 0.0, {"A", "B"});
  ASSERT_EQ(diagram.traces.size(), 3U);
  EXPECT_EQ(diagram.begin, 1e6 * slots[1].on_s);
  EXPECT_THAT(texts_of(diagram), ElementsAre("settle 320 µs", "8 conversions, 48 µs each", "off 200 µs"));
  const auto with = slot_timing(slots[1], timing, 35e-6, {"A", "B"});
  ASSERT_EQ(with.traces.size(), 4U);
  EXPECT_GT(with.traces[1].level.maxCoeff(), 0.999);
  EXPECT_LT(with.traces[1].level[199], 0.01) << "dark before the next LED";
  const auto svg = figure_svg({.panels = {timing_panel(with)}});
  for (const char* part : {"amplifier", "A/D, camera B", "settle 320"}) EXPECT_THAT(svg, HasSubstr(part));
}

}  // namespace
}  // namespace kinemark::report
