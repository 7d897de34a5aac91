// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/comedi/comedi_plan.h"

#include <gmock/gmock.h>

#include <array>

namespace kinemark::stream {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

BoardFacts board() {
  return {.name = "test board",
          .channels = 10,
          .highest_code = 65535,
          .ranges = {{.lowest_v = -10.0, .highest_v = 10.0}},
          .conversion_ns = 1000,
          .analog_outputs = 2,
          .digital_outputs = 8};
}

ScanPlan plan() {
  return {.leds = {"hand", "wrist"},
          .cameras = {"A", "B"},
          .rate_hz = 100.0,
          .timing = {.conversion_s = 50e-6},
          .intensity = {}};
}

std::string refusal(const ScanPlan& wanted) {
  const auto clock = scan_clock(wanted, board());
  return clock ? "can be" : clock.error().message;
}

TEST(BoardCapabilities, AreCamerasOfFourInputs) {
  const auto can = board_capabilities(board());
  EXPECT_EQ(can.name, "test board");
  EXPECT_EQ(can.cameras, 2);
  EXPECT_EQ(can.most_leds, 0);
  EXPECT_EQ(can.bits, 15);
  EXPECT_DOUBLE_EQ(can.fastest.slot_s(2), 8e-6);
  EXPECT_EQ(can.analog_outputs, 2);
  EXPECT_EQ(can.digital_outputs, 8);
  EXPECT_FALSE(can.sets_intensity || can.has_dark_slot);
  auto twelve = board();
  twelve.highest_code = 4095;
  EXPECT_EQ(board_capabilities(twelve).bits, 12);
}

TEST(ScanClockOfAPlan, HasAScanForEachLed) {
  const auto clock = scan_clock(plan(), board());
  ASSERT_TRUE(clock) << clock.error().message;
  EXPECT_EQ(clock->scan_ns, 5'000'000);
  EXPECT_EQ(clock->conversion_ns, 50'000);
  auto fastest = plan();
  fastest.rate_hz = 0.0;
  fastest.timing.conversion_s = 0.0;
  EXPECT_EQ(scan_clock(fastest, board())->scan_ns, 8000);
  EXPECT_EQ(scan_clock(fastest, board())->conversion_ns, 1000);
}

TEST(ScanClockOfAPlan, RefusesWhatDoesNotFit) {
  auto wanted = plan();
  wanted.rate_hz = 1300.0;
  EXPECT_EQ(refusal(wanted), "2 LEDs at 1300 Hz do not fit: the highest rate is 1250.0 Hz");
  wanted.rate_hz = 1250.0;
  EXPECT_EQ(refusal(wanted), "can be");
  wanted.rate_hz = 0.1;
  EXPECT_THAT(refusal(wanted), HasSubstr("the lowest rate is 0.125 Hz"));
  wanted.rate_hz = -3.0;
  EXPECT_THAT(refusal(wanted), HasSubstr("a rate of -3 Hz"));
  wanted = plan();
  wanted.timing.conversion_s = 2.0;
  EXPECT_THAT(refusal(wanted), HasSubstr("conversions of 2 s"));
}

TEST(ScanClockOfAPlan, RefusesWhatABoardHasNot) {
  auto wanted = plan();
  wanted.cameras = {"A", "B", "C"};
  EXPECT_EQ(refusal(wanted), "test board has inputs for 2 cameras, 10 channels; 3 are named");
  wanted = plan();
  wanted.leds.clear();
  EXPECT_EQ(refusal(wanted), "a plan has one LED or more");
  wanted = plan();
  wanted.timing.dark_slot = true;
  EXPECT_EQ(refusal(wanted), "test board has no dark slot");
  wanted = plan();
  wanted.intensity = {1.0, 0.5};
  EXPECT_THAT(refusal(wanted), HasSubstr("lights no LEDs"));
  wanted = plan();
  wanted.trigger = Trigger::digital_line;
  EXPECT_THAT(refusal(wanted), HasSubstr("no line that starts it"));
}

TEST(GrantedScans, HaveTheTimeOfEachConversion) {
  const auto granted = granted_scans(plan(), {.scan_ns = 5'000'000, .conversion_ns = 50'000}, board());
  EXPECT_DOUBLE_EQ(granted.plan.rate_hz, 100.0);
  EXPECT_DOUBLE_EQ(granted.plan.timing.slot_s(2), 5e-3);
  EXPECT_EQ(granted.layout.highest_code, 32767);
  EXPECT_NEAR(granted.layout.offset_s(1, 1)[3], 5e-3 + 7 * 50e-6, 1e-15);
  EXPECT_TRUE(granted.layout.validate());
  EXPECT_THAT(granted.plan.intensity, ElementsAre(1.0, 1.0));
}

TEST(AppendCounts, KeepsFifteenBitsOfSixteenAndAllOfTwelve) {
  const std::array<std::uint16_t, 4> two{0, 1, 40001, 65535};
  std::vector<std::int16_t> counts;
  append_counts(std::as_bytes(std::span(two)), 2, board(), counts);
  EXPECT_THAT(counts, ElementsAre(0, 0, 20000, 32767));
  auto twelve = board();
  twelve.highest_code = 4095;
  const std::array<std::uint32_t, 3> four{7, 4095, 70000};
  counts.clear();
  append_counts(std::as_bytes(std::span(four)), 4, twelve, counts);
  EXPECT_THAT(counts, ElementsAre(7, 4095, 4095));
  EXPECT_ANY_THROW(append_counts(std::as_bytes(std::span(two)).first(3), 2, board(), counts));
}

}  // namespace
}  // namespace kinemark::stream
