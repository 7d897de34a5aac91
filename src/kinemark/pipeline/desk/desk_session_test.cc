// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/desk_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::pipeline {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// A session whose device runs.
DeskSession running(FakeDesk& desk, const Wanted& wanted = rig_at()) {
  DeskSession session(desk, wanted);
  session.start(wanted);
  return session;
}

TEST(DeskSession, WhatDoesNotBelongToTheStepDoesNothing) {
  FakeDesk desk;
  DeskSession session(desk, {});
  session.record();
  session.stop();
  session.keep();
  session.discard();
  session.start(rig_at());
  session.set_up();
  session.leave_source();
  session.set_intensity(0, 0.5);
  session.restart_guide();
  EXPECT_EQ(session.state().step, DeskStep::source);
  EXPECT_TRUE(desk.calls.empty());
}

TEST(DeskSession, KeepsItsTrialWhenItIsLeft) {
  for (const int presses : {0, 1, 2}) {
    FakeDesk desk;
    DeskSession session = running(desk);
    if (presses > 0) session.record();
    if (presses > 1) session.stop();
    session.leave();
    EXPECT_EQ(session.state().step, DeskStep::ended);
    EXPECT_EQ(session.state().kept.size(), presses == 0 ? 0U : 1U);
    EXPECT_EQ(desk.calls.back(), "close");
  }
}

TEST(DeskSession, ATrialOfADeviceThatGivesNoMoreIsOver) {
  FakeDesk desk;
  DeskSession session = running(desk);
  session.record();
  session.tick();
  EXPECT_EQ(session.state().step, DeskStep::recording);
  desk.now.ended = true;
  session.tick();
  EXPECT_EQ(session.state().step, DeskStep::check);
  EXPECT_EQ(session.state().check.size(), 2U);
}

TEST(DeskSession, IntensityStaysWithinItsRangeAndItsLeds) {
  FakeDesk desk;
  DeskSession session = running(desk);
  session.set_intensity(1, 0.01);
  EXPECT_THAT(session.state().granted.plan.intensity, ElementsAre(1.0, 0.1, 1.0));
  session.set_intensity(1, 7.0);
  EXPECT_THAT(session.state().granted.plan.intensity, ElementsAre(1.0, 1.0, 1.0));
  session.set_intensity(3, 0.5);
  session.set_intensity(-1, 0.5);
  EXPECT_THAT(session.state().granted.plan.intensity, ElementsAre(1.0, 1.0, 1.0));
}

TEST(DeskSession, SaysThatLightCannotBeSetWhereItCannot) {
  FakeDesk desk;
  DeskSession session = running(desk);
  session.set_intensity(0, 0.5);
  EXPECT_THAT(session.state().message, Not(HasSubstr("The light of this device's LEDs cannot be set")));
  desk.device.sets_intensity = false;
  DeskSession other = running(desk);
  other.set_intensity(0, 0.5);
  EXPECT_THAT(other.state().message, HasSubstr("The light of this device's LEDs cannot be set"));
  EXPECT_EQ(other.state().granted.plan.intensity[0], 1.0);
}

TEST(DeskSession, ATrialsNameCountsOnOnceItIsKept) {
  FakeDesk desk;
  DeskSession session = running(desk);
  session.record();
  session.stop();
  session.discard();
  EXPECT_EQ(session.state().wanted.trial, "01");
  session.record();
  session.stop();
  session.keep();
  EXPECT_EQ(session.state().wanted.trial, "02");
  EXPECT_THAT(desk.calls, Contains("discard"));
}

TEST(DeskSession, ASourceIsLeftAndAnotherOpened) {
  FakeDesk desk;
  DeskSession session(desk, rig_at());
  EXPECT_EQ(session.state().step, DeskStep::plan);
  session.leave_source();
  EXPECT_EQ(session.state().step, DeskStep::source);
  session.open("serial:/dev/ttyACM0");
  EXPECT_EQ(session.state().message, "serial:/dev/ttyACM0: another program has it");
  session.open("sim:rig");
  EXPECT_EQ(session.state().message, "");
}

TEST(DeskSession, TroubleIsGoneOnceItIsOver) {
  FakeDesk desk;
  DeskSession session = running(desk);
  desk.now.trouble = "the plug is out";
  session.tick();
  EXPECT_EQ(session.state().message, "the plug is out");
  desk.now.trouble.clear();
  session.tick();
  EXPECT_EQ(session.state().message, "");
}

TEST(DeskSession, TroubleThatGoesOnIsThereInTheTrialToo) {
  FakeDesk desk;
  desk.now.trouble = "the plug is out";
  DeskSession session = running(desk);
  EXPECT_EQ(session.state().message, "the plug is out");
  session.record();
  EXPECT_EQ(session.state().message, "the plug is out");
}

TEST(DeskSession, NamesOfTrialsAreFree) {
  FakeDesk desk;
  desk.taken = {"01", "02", "04"};
  DeskSession session = running(desk);
  EXPECT_EQ(session.state().wanted.trial, "03");
  session.record();
  session.stop();
  session.keep();
  EXPECT_EQ(session.state().wanted.trial, "05");
}

TEST(DeskStep, HasANameForEach) {
  EXPECT_EQ(to_string(DeskStep::source), "source");
  EXPECT_EQ(to_string(DeskStep::ended), "ended");
}

}  // namespace
}  // namespace kinemark::pipeline
