// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/trial_notes.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace kinemark::pipeline {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

data::Counts layout() {
  return data::Counts::zeros({"hand", "wrist"}, {"A", "B"}, {.rate_hz = 100.0}, false);
}

Recorded good() {
  Recorded out{.progress = {.frames = 100, .received = 100, .acknowledged = 100}};
  out.lit.assign(4, {.frames = 100, .mean = {500, 500, 500, 500}, .sd = {2.0, 2.5, 3.0, 2.5}, .still = true});
  return out;
}

std::vector<std::string> said_of(const Recorded& recorded, const data::Counts& counts) {
  std::vector<std::string> texts;
  for (const auto& note : describe_trial(recorded, counts)) texts.push_back(note.text);
  return texts;
}

TEST(TrialNotes, AreGoodWhereNothingIsWrong) {
  const auto all_good = [](const Recorded& recorded) {
    return std::ranges::all_of(describe_trial(recorded, layout()), &TrialNote::good);
  };
  EXPECT_TRUE(all_good(good()));
  for (const int which : {0, 1, 2, 3}) {
    auto trial = good();
    if (which < 2) trial.progress.acknowledged = 99;
    if (which == 0) trial.progress.dropped_by_device = 1;
    if (which == 1) trial.progress.dropped_here = 1;
    if (which == 2) trial.progress.reopened = 1;
    if (which == 3) trial.lit[0].saturated = 1;
    EXPECT_FALSE(all_good(trial)) << which;
  }
  EXPECT_FALSE(all_good({}));
}

TEST(TrialNotes, OfAGoodTrialSayNothingElse) {
  EXPECT_THAT(
      said_of(good(), layout()),
      ElementsAre("all 100 frames came and are kept",
                  "LEDs that stood still have an SD of 2.50 counts, 2.00 to 3.00 (4 of 4 LEDs at their "
                  "cameras)"));
  const auto said = said_of(good(), layout());
  EXPECT_THAT(said, Each(Not(HasSubstr("every LED moved: hold one still"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("the device lost {} of 100 frames: nobody read it in time"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("frames came and were dropped here"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("the device was away and came back"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("frames: give it less light, or more distance"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("by this machine's clock the device gives"))));
  EXPECT_THAT(said_of(good(), layout()),
              Not(Contains(HasSubstr(": look at its wire, and whether the camera sees it"))));
  EXPECT_THAT(said_of(good(), layout()), Not(Contains(HasSubstr("the trial did not begin: no frame came"))));
  EXPECT_TRUE(missing_gate(good().progress).passed);
}

TEST(TrialNotes, TellWhoLostWhat) {
  auto trial = good();
  trial.progress.dropped_by_device = 30;
  trial.progress.acknowledged = 70;
  auto said = said_of(trial, layout());
  EXPECT_THAT(said, Contains(HasSubstr("the device lost 30 of 100 frames: nobody read it in time")));
  EXPECT_THAT(said, Each(Not(HasSubstr("dropped here"))));
  EXPECT_THAT(said, Each(Not(HasSubstr("frames came and are kept"))));
  trial.progress = {.frames = 100, .acknowledged = 95, .dropped_here = 5, .reopened = 1};
  said = said_of(trial, layout());
  EXPECT_THAT(said, Contains(HasSubstr("5 of 100 frames came and were dropped here")));
  EXPECT_THAT(said, Contains(HasSubstr("was away and came back 1 time;")));
  EXPECT_THAT(said, Each(Not(HasSubstr("the device lost"))));
  EXPECT_FALSE(missing_gate(trial.progress).passed);
  EXPECT_EQ(missing_gate(trial.progress).value, 5.0);
  EXPECT_THAT(missing_gate(trial.progress).sentence, HasSubstr("5 of 100 frames are missing; need 0"));
}

TEST(TrialNotes, NameTheLedThatSaturatesACamera) {
  auto trial = good();
  trial.lit[3].saturated = 7;
  const auto said = said_of(trial, layout());
  EXPECT_THAT(
      said, Contains(HasSubstr(
                "LED 'wrist' saturates camera B in 7 of 100 frames: give it less light, or more distance")));
  EXPECT_THAT(said, Each(Not(HasSubstr("'hand'"))));
}

TEST(TrialNotes, NameALedThatIsDark) {
  auto trial = good();
  trial.lit[2].mean = {10, 12, 9, 11};
  trial.lit[2].sd = {0, 0, 0, 0};
  const auto said = said_of(trial, layout());
  EXPECT_THAT(said,
              Contains(HasSubstr(
                  "LED 'wrist' is dark at camera A: look at its wire, and whether the camera sees it")));
  EXPECT_THAT(said, Contains(HasSubstr("2.00 to 3.00 (3 of 4 LEDs")));  // it is none that stood still
  EXPECT_THAT(said, Each(Not(HasSubstr("'hand'"))));
}

TEST(TrialNotes, SayThatATriggerNeverCame) {
  Recorded trial;
  trial.progress.begun = false;
  EXPECT_THAT(said_of(trial, layout()),
              ElementsAre(HasSubstr("the trial did not begin: no frame came in which the LED")));
}

TEST(TrialNotes, OfASingleFrameSayNothingOfMovement) {
  auto trial = good();
  trial.progress = {.frames = 1, .received = 1, .acknowledged = 1};
  for (auto& levels : trial.lit)
    levels = {.frames = 1, .mean = {500, 500, 500, 500}, .sd = Eigen::Vector4d::Constant(kNaN)};
  EXPECT_THAT(said_of(trial, layout()), Each(Not(HasSubstr("every LED moved"))));
}

TEST(TrialNotes, AskForAStillLedWhereAllMoved) {
  auto trial = good();
  for (auto& levels : trial.lit) levels.still = false;
  const auto said = said_of(trial, layout());
  EXPECT_THAT(said, Contains("every LED moved: hold one still for a second to see its noise"));
  EXPECT_THAT(said, Each(Not(HasSubstr("LEDs that stood still have an SD"))));
}

TEST(TrialNotes, SayHowFastTheClockIs) {
  auto trial = good();
  trial.clock = {.rate_hz = 138.0414, .sd_hz = 1e-5, .ppm_fast = 300.04, .sd_ppm = 0.07, .span_s = 60.0};
  EXPECT_THAT(said_of(trial, layout()),
              Contains(HasSubstr("by this machine's clock the device gives 138.041400 +- 0.000010 frames per "
                                 "second: its clock is 300.04 +- 0.07 ppm fast")));
  trial.clock->ppm_fast = -12.0;
  EXPECT_THAT(said_of(trial, layout()), Contains(HasSubstr("12.00 +- 0.07 ppm slow")));
}

TEST(TrialNotes, OfNothingSaySo) { EXPECT_THAT(said_of({}, layout()), ElementsAre("no frame came")); }

}  // namespace
}  // namespace kinemark::pipeline
