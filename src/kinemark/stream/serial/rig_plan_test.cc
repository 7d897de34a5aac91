// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/rig_plan.h"

#include <gmock/gmock.h>

namespace kinemark::stream {
namespace {

using ::testing::HasSubstr;

RigAnswer answer(std::string_view text) { return find_answer(checked_line(text)).value(); }

constexpr std::string_view kFacts =
    "rig name=rig328p version=1.0 protocol=1 leds=8 cameras=2 bits=10 clock=2000000 settle=40 conversion=128 "
    "off=60 longest=60000 period=2000000 hold=16 levels=255 dark=1 outputs=2 trigger=1 millivolts=5000";

SerialRigFacts facts() { return serial_facts(answer(kFacts)).value(); }

ScanPlan plan() {
  return {.leds = {"hand", "wrist"}, .cameras = {"A", "B"}, .rate_hz = 100.0, .timing = {}, .intensity = {}};
}

std::string refused(const ScanPlan& wanted, const SerialRigFacts& of = facts()) {
  const auto command = plan_command(wanted, of);
  return command ? *command : command.error().message;
}

std::string granted_or_why(std::string_view text, const ScanPlan& wanted = plan()) {
  const auto granted = granted_plan(wanted, answer(text), facts());
  return granted ? "granted" : granted.error().message;
}

TEST(SerialFacts, AreThoseOfTheRig) {
  const auto can = serial_capabilities(facts());
  EXPECT_EQ(can.name, "rig328p 1.0");
  EXPECT_EQ(can.most_leds, 8);
  EXPECT_EQ(can.cameras, 2);
  EXPECT_EQ(can.bits, 10);
  EXPECT_EQ(can.ranges.at(0).highest_v, 5.0);
  EXPECT_DOUBLE_EQ(can.fastest.settle_s, 28e-6);
  EXPECT_DOUBLE_EQ(can.fastest.conversion_s, 64e-6);
  EXPECT_DOUBLE_EQ(can.fastest.off_s, 22e-6);
  EXPECT_DOUBLE_EQ(can.lowest_rate_hz, 1.0);
  EXPECT_TRUE(can.sets_intensity && can.has_dark_slot);
  EXPECT_EQ(can.digital_outputs, 2);
  EXPECT_EQ(can.analog_outputs, 0);
  EXPECT_THAT(can.triggers, ::testing::ElementsAre(Trigger::at_once, Trigger::digital_line));
}

TEST(SerialFacts, OfNoRigAreRefused) {
  EXPECT_EQ(serial_facts(answer("stop protocol=1")).error().code, Code::device);
  EXPECT_THAT(serial_facts(answer("rig name=x protocol=2")).error().message, HasSubstr("protocol '2'"));
  EXPECT_THAT(serial_facts(answer("rig name=x protocol=1")).error().message, HasSubstr("no rig can be"));
}

TEST(PlanCommand, IsInTicksBeforeTheSample) {
  auto wanted = plan();
  EXPECT_EQ(refused(wanted), "plan 2 0 20000 624 96 416 0");
  wanted.intensity = {1.0, 0.5};
  wanted.timing.dark_slot = true;
  wanted.rate_hz = 0.0;
  wanted.trigger = Trigger::digital_line;
  EXPECT_EQ(refused(wanted), "plan 2 1 0 624 96 416 1 255 128");
}

TEST(PlanCommand, AsksForNothingThatTheRigHasNot) {
  auto wanted = plan();
  wanted.leds.assign(9, "x");
  EXPECT_EQ(refused(wanted), "rig328p lights 1 to 8 LEDs; 9 are asked for");
  wanted = plan();
  wanted.cameras = {"A"};
  EXPECT_EQ(refused(wanted), "rig328p has 2 cameras; 1 are named");
  wanted = plan();
  wanted.rate_hz = -1.0;
  EXPECT_THAT(refused(wanted), HasSubstr("a rate of -1 Hz"));
  wanted = plan();
  wanted.intensity = {1.0};
  EXPECT_EQ(refused(wanted), "1 intensities of 2 LEDs");
  wanted.intensity = {1.0, 1.5};
  EXPECT_THAT(refused(wanted), HasSubstr("share of full light"));
  auto poor = facts();
  poor.has_dark = poor.trigger = false;
  wanted = plan();
  wanted.timing.dark_slot = true;
  EXPECT_EQ(refused(wanted, poor), "rig328p has no dark slot");
  wanted = plan();
  wanted.trigger = Trigger::digital_line;
  EXPECT_EQ(refused(wanted, poor), "rig328p has no line that starts it");
}

TEST(GrantedPlan, HasTheTimesThatTheRigWillKeep) {
  auto wanted = plan();
  wanted.intensity = {1.0, 0.5};
  wanted.timing.dark_slot = true;
  const auto granted = granted_plan(
      wanted,
      answer("plan leds=2 dark=1 period=20000 settle=624 conversion=128 off=416 trigger=0 level=255,128"),
      facts());
  ASSERT_TRUE(granted) << granted.error().message;
  EXPECT_DOUBLE_EQ(granted->plan.rate_hz, 100.0);
  EXPECT_DOUBLE_EQ(granted->plan.timing.settle_s, 320e-6);
  EXPECT_DOUBLE_EQ(granted->plan.timing.conversion_s, 64e-6);
  EXPECT_DOUBLE_EQ(granted->plan.timing.off_s, 200e-6);
  EXPECT_DOUBLE_EQ(granted->plan.intensity[1], 128.0 / 255.0);
  const auto& layout = granted->layout;
  EXPECT_TRUE(layout.validate());
  EXPECT_EQ(layout.highest_code, 1023);
  // LED 2, camera B, third electrode: 2,080 ticks of the first slot, 640 to the first sample, 6 conversions
  // on.
  EXPECT_NEAR(layout.offset_s(1, 1)[2], (2064 + 640 + 6 * 128) * 0.5e-6, 1e-12);
  EXPECT_NEAR(layout.dark_offset_s(0)[0], (2 * 2064 + 640) * 0.5e-6, 1e-12);
}

TEST(GrantedPlan, OfFullLightWhenTheRigCannotDim) {
  auto plain = facts();
  plain.levels = 0;
  const auto granted = granted_plan(
      plan(), answer("plan leds=2 dark=0 period=20000 settle=624 conversion=128 off=416 trigger=0 level="),
      plain);
  ASSERT_TRUE(granted) << granted.error().message;
  EXPECT_THAT(granted->plan.intensity, ::testing::ElementsAre(1.0, 1.0));
}

TEST(GrantedPlan, IsRefusedWithWhatIsPossible) {
  auto wanted = plan();
  wanted.rate_hz = 700.0;
  EXPECT_EQ(granted_or_why("no why=period least=4128 most=2000000", wanted),
            "2 LEDs at 700 Hz do not fit: the highest rate is 484.4 Hz");
  wanted.rate_hz = 0.5;
  EXPECT_EQ(granted_or_why("no why=period least=4128 most=2000000", wanted),
            "0.5 Hz is too slow for rig328p: the lowest rate is 1 Hz");
  EXPECT_THAT(granted_or_why("no why=period least=4000000 most=2000000"),
              HasSubstr("do not fit into the longest frame, 1 s"));
  EXPECT_EQ(granted_or_why("no why=runs"), "rig328p refuses the plan: runs");
}

TEST(GrantedPlan, IsNoneThatWasNotAskedFor) {
  const std::string_view rest = " settle=624 conversion=128 off=416 trigger=0 level=255,255";
  const auto why = [&](std::string_view first) {
    return granted_or_why(std::string(first) + std::string(rest));
  };
  EXPECT_EQ(why("plan leds=2 dark=0 period=20000"), "granted");
  for (const auto* other : {"plan leds=3 dark=0 period=20000", "plan leds=2 dark=1 period=20000",
                            "plan leds=2 dark=0 period=0", "stop leds=2 dark=0 period=20000"})
    EXPECT_THAT(why(other), HasSubstr("was not asked for")) << other;
  EXPECT_EQ(why("plan leds=2 dark=0 period=4128"), "granted");
  EXPECT_THAT(why("plan leds=2 dark=0 period=4100"), HasSubstr("longer than its frames"));
  for (const auto* level : {"255", "255,0", "255,256", "255,x"})
    EXPECT_THAT(
        granted_or_why(std::string("plan leds=2 dark=0 period=20000 settle=624 conversion=128 off=416 "
                                   "trigger=0 level=") +
                       level),
        HasSubstr("intensities"))
        << level;
}

TEST(FrameShapeOfAPlan, HasTheDarkSlotToo) {
  auto wanted = plan();
  EXPECT_EQ(frame_shape(wanted).bytes(), 34U);
  wanted.timing.dark_slot = true;
  EXPECT_EQ(frame_shape(wanted).slots, 3);
}

}  // namespace
}  // namespace kinemark::stream
