// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/check_up.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "kinemark/pipeline/acquire/acquire_job.h"

namespace kinemark::pipeline {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

template <class Matcher>
auto text(const Matcher& matcher) {
  return Field(&TrialNote::text, matcher);
}
auto warns(const char* words) {
  return Contains(AllOf(text(HasSubstr(words)), Field(&TrialNote::good, false)));
}

// Two LEDs at two cameras: 138 Hz, 12 bits, everything as it should be.
struct Healthy {
  stream::GrantedPlan plan;
  Recorded recorded;
  Healthy() {
    plan.layout = data::Counts::zeros({"hand", "wrist"}, {"A", "B"}, {.rate_hz = 138.0}, true);
    recorded.progress = {.frames = 1380, .received = 1380};
    recorded.clock = stream::ClockRate{.rate_hz = 138.01,
                                       .sd_hz = 0.01,
                                       .ppm_fast = 72.0,
                                       .sd_ppm = 70.0,
                                       .span_s = 10.0,
                                       .delay_sd_s = 2e-4};
    for (int at = 0; at < 4; ++at)
      recorded.lit.push_back({.frames = 1380,
                              .mean = {400.0 + 100 * at, 500, 600, 450.0 - 50 * at},
                              .sd = {1, 1, 1, 1},
                              .noise = {1.0, 1.1, 0.9, 1.0}});
    recorded.lit[0].mean(1) = 520;
    recorded.lit[1].mean(1) = recorded.lit[1].mean(2) = 700;
    recorded.crosstalk.assign(2, {.share = {1e-4, -1e-4, 0, 0}, .sd = {1e-4, 1e-4, 1e-4, 1e-4}});
    recorded.crosstalk_led = 1;
    recorded.dark.assign(2, {.frames = 1380, .mean = {16, 17, 15, 16}, .noise = {0.9, 1.0, 0.9, 1.0}});
  }
  [[nodiscard]] std::vector<TrialNote> lines() const { return check_up(recorded, plan); }
};

TEST(CheckUp, OfAHealthyDeviceHasNothingToDo) {
  const auto lines = Healthy().lines();
  EXPECT_THAT(lines, Each(Field(&TrialNote::good, true)));
  EXPECT_THAT(lines, Contains(text(HasSubstr("138.0100 +- 0.0100 frames per second, 138.0000 granted"))));
  EXPECT_THAT(lines, Contains(text(HasSubstr("none of 1380 frames is missing"))));
  EXPECT_THAT(lines, Contains(text(HasSubstr("camera A in the dark: 15.0 to 17.0 counts"))));
  EXPECT_THAT(lines, Contains(text(HasSubstr("noise of 8 channels: 0.90 to 1.00 counts"))));
  EXPECT_THAT(lines, Contains(text(HasSubstr(
                         "LED 'hand': brightest channel at 15 % of the codes in camera A; brightest channel "
                         "at 17 % of the codes in camera B"))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("the device does not keep its rate")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(" frames are missing: end other programs")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(": a channel is cut off at code 0; raise its offset")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(": the room is too bright; dim it")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(" follows no light: look at its wire")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(" are usual: look at its cable, its shield")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(": look at its wire, and whether the camera sees it")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr(": give it less light, or more distance")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("the rate was not measured: two seconds")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("the dark level is not known: there is no dark slot")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("no frame came: is it running")))));
  EXPECT_THAT(lines, Contains(text("crosstalk into the slot after LED 'wrist': 0.03 % or less at camera A")));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("is still there in the slot after it, channel")))));
  EXPECT_THAT(lines,
              Not(Contains(text(HasSubstr("crosstalk into the slot after LED 'wrist' is not known")))));
  EXPECT_THAT(lines, Not(Contains(text(HasSubstr("crosstalk from slot to slot is not known: there")))));
  EXPECT_TRUE(check_up_gate(lines).passed);
}

TEST(CheckUp, SaysWhatIsLeftOfTheSlotBefore) {
  Healthy device;
  device.recorded.crosstalk[1].share(2) = 0.02;
  device.recorded.crosstalk[1].sd(2) = 0.001;
  EXPECT_THAT(device.lines(),
              warns("2.00 +- 0.10 % of the light of LED 'wrist' is still there in the slot after "
                    "it, channel +y of camera B: an amplifier has not settled"));
  device.recorded.crosstalk[1].sd(2) = 0.006;  // it may be none
  EXPECT_THAT(device.lines(), Not(Contains(text(HasSubstr("is still there in the slot after it, channel")))));
  EXPECT_THAT(
      device.lines(),
      Contains(text(HasSubstr("crosstalk into the slot after LED 'wrist' is not known at camera B"))));
  device.recorded.crosstalk[1].share(2) = device.recorded.crosstalk[1].sd(2) = kNaN;  // too few frames
  EXPECT_THAT(
      device.lines(),
      Contains(text(HasSubstr("crosstalk into the slot after LED 'wrist' is not known at camera B"))));
  device.recorded.crosstalk.clear();
  device.recorded.crosstalk_led = -1;
  EXPECT_THAT(device.lines(), Contains(text(HasSubstr("crosstalk from slot to slot is not known: there"))));
}

TEST(CheckUp, SaysWhenTheRateIsNotKept) {
  Healthy device;
  device.recorded.clock->ppm_fast = -2000.0;
  EXPECT_THAT(device.lines(), warns("the device does not keep its rate"));
  EXPECT_FALSE(check_up_gate(device.lines()).passed);
  device.recorded.clock->sd_ppm = 600.0;  // it may be the granted one
  EXPECT_THAT(device.lines(), Not(Contains(text(HasSubstr("the device does not keep its rate")))));
  device.recorded.clock.reset();
  EXPECT_THAT(device.lines(), Contains(text(HasSubstr("the rate was not measured: two seconds"))));
}

TEST(CheckUp, SaysWhatIsMissing) {
  Healthy device;
  device.recorded.progress.dropped_by_device = 3;
  EXPECT_THAT(device.lines(), warns("3 of 1380 frames are missing: end other programs"));
  EXPECT_THAT(device.lines(), Not(Contains(text(HasSubstr(" frames is missing")))));
}

TEST(CheckUp, JudgesTheDarkLevel) {
  Healthy device;
  device.recorded.dark[1].mean(2) = 0.2;
  EXPECT_THAT(
      device.lines(),
      warns("camera B in the dark: 0.2 to 17.0 counts: a channel is cut off at code 0; raise its offset"));
  device.recorded.dark[1].mean = {500, 400, 400, 400};
  EXPECT_THAT(device.lines(), warns(": the room is too bright; dim it"));
  device.recorded.dark.clear();
  EXPECT_THAT(device.lines(),
              Contains(text(HasSubstr("the dark level is not known: there is no dark slot"))));
}

TEST(CheckUp, NamesTheNoisyChannelAndTheDeadOne) {
  Healthy device;
  for (int led = 0; led < 2; ++led) device.recorded.lit[static_cast<std::size_t>(2 * led + 1)].noise(3) = 9.0;
  device.recorded.dark[1].noise(3) = 9.0;
  EXPECT_THAT(device.lines(), warns("channel -y of camera B has a noise of 9.00 counts where 0.95 are usual: "
                                    "look at its cable, its shield"));
  device.recorded.dark[1].noise(3) = 1.0;  // it is the LEDs that move
  EXPECT_THAT(device.lines(), Not(Contains(text(HasSubstr(" are usual: look at its cable, its shield")))));
  for (const std::size_t at : {0U, 2U}) device.recorded.lit[at].mean(0) = 16.3;
  EXPECT_THAT(device.lines(), warns("channel +x of camera A follows no light: look at its wire"));
}

TEST(CheckUp, NamesLedsThatAreDarkOrTooBright) {
  Healthy device;
  device.recorded.lit[3].mean = {20, 20, 25, 22};
  device.recorded.lit[0].saturated = 5;
  EXPECT_THAT(device.lines(), warns("LED 'wrist': brightest channel at 15 % of the codes in camera A; dark "
                                    "in camera B: look at its wire, and whether the camera sees it"));
  EXPECT_THAT(device.lines(), warns("LED 'hand': saturates camera A: give it less light, or more distance"));
}

TEST(CheckUp, SaysFromWhichCameraNothingCame) {
  Healthy device;
  device.recorded.lit[1] = {
      .frames = 0, .mean = Eigen::Vector4d::Constant(kNaN), .noise = Eigen::Vector4d::Constant(kNaN)};
  EXPECT_THAT(device.lines(), warns("no frame came from camera B"));
  EXPECT_THAT(Healthy().lines(), Not(Contains(text(HasSubstr("no frame came from camera")))));
}

TEST(CheckUp, OfADeviceThatGivesNothingSaysSo) {
  Healthy device;
  device.recorded.progress = {};
  EXPECT_THAT(device.lines(), warns("no frame came: is it running"));
}

// What the simulated rig says, with a fault planted.
std::vector<TrialNote> of_rig(const std::string& fault) {
  AcquireJob job;
  job.source = "sim:rig?scene=tree&dark&fast" + fault;
  job.check_up = true;
  job.frames = 500;
  const auto outcome = run_acquire(job);
  EXPECT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), std::ranges::all_of(outcome->notes, &TrialNote::good) ? 0 : 1);
  EXPECT_TRUE(outcome->written.empty());
  return outcome->notes;
}

TEST(CheckUp, FindsTheFaultsOfTheSimulatedRigAndNoOthers) {
  for (const char* seed : {"1", "2", "3", "4", "5"}) {
    const std::string rig = std::string("&seed=") + seed;
    EXPECT_THAT(of_rig(rig), Each(Field(&TrialNote::good, true))) << seed;
    const auto wrong = [&](const std::string& fault) {
      std::vector<std::string> texts;
      for (const auto& note : of_rig(rig + fault))
        if (!note.good) texts.push_back(note.text);
      return texts;
    };
    EXPECT_THAT(wrong("&dark_led=2"), testing::ElementsAre(HasSubstr("LED 'back right': dark in camera A")))
        << seed;
    EXPECT_THAT(wrong("&bright_led=1"),
                testing::ElementsAre(HasSubstr("LED 'back left': saturates camera A")))
        << seed;
    EXPECT_THAT(wrong("&noisy_channel=6"),
                testing::ElementsAre(HasSubstr("channel -x of camera B has a noise of")))
        << seed;
  }
}

TEST(CheckUp, FindsAnAfterglowOfTheSimulatedRig) {
  const auto of_sign = [](const std::string& fault) {
    AcquireJob job;
    job.source = "sim:rig?scene=sign&dark&fast&rate=100&seed=7" + fault;
    job.check_up = true;
    return run_acquire(job).value().notes;
  };
  EXPECT_THAT(of_sign("&afterglow=0.01"), warns("% of the light of LED"));
  EXPECT_THAT(of_sign(""), Not(Contains(text(HasSubstr("is still there in the slot after it, channel")))));
  EXPECT_THAT(of_sign(""), Contains(text(HasSubstr("% or less at camera A")))) << "the LED moves";
}

TEST(CheckUp, KeepsNothing) {
  AcquireJob job;
  job.source = "sim:rig?fast";
  job.check_up = true;
  job.output = "trial.mcap";
  EXPECT_THAT(run_acquire(job).error().message, HasSubstr("a check-up keeps nothing"));
}

}  // namespace
}  // namespace kinemark::pipeline
