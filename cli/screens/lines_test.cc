// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::screens {
namespace {

using pipeline::FakeDesk;
using pipeline::rig_at;
using pipeline::Wanted;

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Answers typed one after the other; "..." waits in vain once, then the input is closed at the end.
struct Session {
  std::deque<std::string> typed;
  std::string shown;
  std::vector<std::string> kept;

  Session(FakeDesk& desk, const Wanted& wanted, std::deque<std::string> lines) : typed(std::move(lines)) {
    const LineTerminal terminal{[&](int) { return next(desk); },
                                [&](const std::string& text) { shown += text; }};
    kept = ask_in_lines(desk, wanted, terminal);
  }
  TypedLine next(FakeDesk& desk) {
    if (typed.empty()) return {TypedLine::Kind::closed, ""};
    const std::string line = typed.front();
    typed.pop_front();
    if (line != "...") return {TypedLine::Kind::line, line};
    desk.now.recorded_s += 1.0;
    return {};
  }
};

TEST(Lines, FromTheSourceToAKeptTrial) {
  FakeDesk desk;
  const Session session(desk, {}, {"1", "hand, elbow", "100", "", "S1", "reach_01", "...", "", "k", "q"});
  EXPECT_THAT(session.kept, ElementsAre("raw/reach_01.mcap"));
  EXPECT_THAT(session.shown, HasSubstr("1  sim:rig  Simulated rig of 1986"));
  EXPECT_THAT(session.shown, HasSubstr("2 LEDs, 2 cameras, 100 Hz"));
  EXPECT_THAT(session.shown, HasSubstr("! LED 2 is dark in camera B"));
  EXPECT_THAT(session.shown, HasSubstr("Name of the next trial; s another source, q ends [reach_02]"));
  EXPECT_EQ(desk.named.subject, "S1");
  EXPECT_EQ(desk.calls.back(), "close");
}

TEST(Lines, EmptyLinesTakeWhatStandsInBrackets) {
  FakeDesk desk;
  const Session session(desk, {}, {"", "", "", "2", "", "", "...", "...", "", "q"});
  EXPECT_THAT(session.kept, ElementsAre("raw/01.mcap"));  // ended by its duration
  EXPECT_EQ(desk.asked.leds.size(), 8U);                  // all that the device has
}

TEST(Lines, ATrialOfADeviceThatGivesNoMoreIsOver) {
  FakeDesk desk;
  desk.now.ended = true;
  const Session session(desk, rig_at(), {"", "", "", "", "", "k", "q"});
  EXPECT_THAT(session.kept, ElementsAre("raw/01.mcap"));
}

TEST(Lines, ARefusedRateIsAskedAgain) {
  FakeDesk desk;
  const Session session(desk, rig_at("8", "200"), {"", "", "", "", "", "138", "", "", "q"});
  EXPECT_THAT(session.shown, HasSubstr("the highest rate is 138 Hz"));
  EXPECT_EQ(desk.asked.rate_hz, 138.0);
  EXPECT_TRUE(session.kept.empty());
}

TEST(Lines, DiscardedIsNotKept) {
  FakeDesk desk;
  const Session session(desk, rig_at(), {"", "", "", "", "", "", "d", "q"});
  EXPECT_TRUE(session.kept.empty());
  EXPECT_THAT(desk.calls, Contains("discard"));
  EXPECT_THAT(session.shown, HasSubstr("Discarded: 01"));
}

TEST(Lines, TheEndOfTheInputKeepsTheTrial) {
  FakeDesk desk;
  const Session session(desk, rig_at(), {"", "", "", "", "walk", "..."});
  EXPECT_THAT(session.kept, ElementsAre("raw/walk.mcap"));
  EXPECT_EQ(desk.calls.back(), "close");
}

TEST(Lines, ASourceThatAnotherHasIsAskedAgain) {
  FakeDesk desk;
  const Session session(desk, {}, {"2", "q"});
  EXPECT_THAT(session.shown, HasSubstr("another program has it"));
  const Session other(desk, {}, {"1"});
  EXPECT_THAT(other.shown, Not(HasSubstr("another program has it")));
}

TEST(Lines, NamesAreFreeAndTroubleIsSaidOnce) {
  FakeDesk desk;
  desk.taken = {"01", "02"};
  desk.now.trouble = "the plug is out";
  const Session session(desk, rig_at(), {"", "", "", "", "", "...", "...", "", "k", "q"});
  EXPECT_THAT(session.kept, ElementsAre("raw/03.mcap"));
  const auto first = session.shown.find("the plug is out", session.shown.find("Recording"));
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(session.shown.find("the plug is out", first + 1), std::string::npos);
}

TEST(Lines, ATrialThatCannotBeginIsSaid) {
  FakeDesk desk;
  desk.disk = fail(Code::io, "the disk is full");
  const Session session(desk, rig_at(), {"", "", "", "", "", "q"});
  EXPECT_THAT(session.shown, HasSubstr("the disk is full"));
  EXPECT_THAT(desk.calls, Not(Contains("record")));
}

}  // namespace
}  // namespace kinemark::screens
