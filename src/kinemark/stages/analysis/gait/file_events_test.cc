// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/gait/gait_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr TimeBase kFiveSeconds{.rate_hz = 100.0, .t0_s = 1.0, .frames = 501};  // 1 to 6 s

TEST(FileEventNames, SideIsThatOfTheContextOrOfTheLabel) {
  struct Case {
    const char *label, *context;
    Side side;
    FootEvent what;
  };
  for (const auto& [label, context, side, what] :
       {Case{"Foot Strike", "Left", Side::left, FootEvent::strike},
        Case{"foot_strike", "RIGHT", Side::right, FootEvent::strike},
        Case{"Heel Strike", "Right", Side::right, FootEvent::strike},
        Case{"Initial Contact", "Left", Side::left, FootEvent::strike},
        Case{"IC", "Left", Side::left, FootEvent::strike},
        Case{"Toe-Off", "Left", Side::left, FootEvent::off}, Case{"TO", "right", Side::right, FootEvent::off},
        Case{"LHS", "", Side::left, FootEvent::strike},
        Case{"RFS", "General", Side::right, FootEvent::strike}, Case{"R_TO", "", Side::right, FootEvent::off},
        Case{"Left Toe Off", "", Side::left, FootEvent::off},
        Case{"right heel contact", "General", Side::right, FootEvent::strike}}) {
    const auto found = events_of_file(std::vector<data::Event>{{label, context, 2.0}}, kFiveSeconds);
    ASSERT_EQ(found.events.size(), 1u) << label;
    EXPECT_EQ(found.events[0].side, side) << label;
    EXPECT_EQ(found.events[0].what, what) << label;
    EXPECT_EQ(found.events[0].source, data::EventSource::file);
    EXPECT_EQ(found.events[0].method, "the file");
    EXPECT_NEAR(found.events[0].sd_s, std::sqrt(356e-6 + 1e-4 / 12.0), 1e-9);  // usual, and a frame
  }
}

TEST(FileEventNames, OthersAreNotAboutFeet) {
  for (const auto& [label, context] :
       std::vector<std::pair<std::string, std::string>>{{"Foot Strike", ""},
                                                        {"Foot Strike", "General"},
                                                        {"Left", ""},
                                                        {"", "Left"},
                                                        {"LHS", "Left"},
                                                        {"Stroke", "Left"},
                                                        {"Foot Strikes", "Right"},
                                                        {"lift", ""}}) {
    const auto found = events_of_file(std::vector<data::Event>{{label, context, 2.0}}, kFiveSeconds);
    EXPECT_TRUE(found.events.empty()) << label;
    EXPECT_TRUE(found.notes.empty()) << label;
  }
}

TEST(FileEventTimes, AscendWhateverTheirOrderInTheFile) {
  const auto found = events_of_file(
      std::vector<data::Event>{
          {"Foot Off", "Left", 2.6}, {"Foot Strike", "Left", 2.0}, {"Foot Strike", "Left", 3.0}},
      kFiveSeconds);
  ASSERT_EQ(found.events.size(), 3u);
  EXPECT_EQ(found.events[0].time_s, 2.0);
  EXPECT_EQ(found.events[1].time_s, 2.6);
  EXPECT_EQ(found.events[2].time_s, 3.0);
  EXPECT_TRUE(found.notes.empty());
}

TEST(FileEventTimes, ReachHalfAFrameBeyondTheRecording) {
  for (const auto& [time_s, within] :
       {std::pair{0.996, true}, std::pair{0.994, false}, std::pair{6.004, true}, std::pair{6.006, false}})
    EXPECT_EQ(events_of_file(std::vector<data::Event>{{"LHS", "", time_s}}, kFiveSeconds).events.size() == 1u,
              within)
        << time_s;
}

TEST(FileEventTimes, OneThatIsNoNumberIsLeftOutAndDoesNotDisturbTheOrder) {
  const auto found = events_of_file(
      std::vector<data::Event>{{"LHS", "", 3.0}, {"LHS", "", kNaN}, {"LHS", "", 2.0}}, kFiveSeconds);
  ASSERT_EQ(found.events.size(), 2u);
  EXPECT_EQ(found.events[0].time_s, 2.0);
  EXPECT_EQ(found.events[1].time_s, 3.0);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_EQ(found.notes[0],
            "the file's event Left Foot Strike at nan s lies outside the recording, 1.000 to 6.000 s, and is "
            "left out");
}

TEST(FileEventTurns, OneOutsideTheRecordingAsksForNone) {
  // The only leaving lies outside: what is left has one kind alone.
  const auto found = events_of_file(
      std::vector<data::Event>{{"LHS", "", 2.0}, {"LHS", "", 3.0}, {"LHS", "", 4.0}, {"LTO", "", 9.0}},
      kFiveSeconds);
  EXPECT_EQ(found.events.size(), 3u);
  EXPECT_EQ(found.notes.size(), 1u);
}

TEST(FileEventTurns, AreTakenBySidesApart) {
  const std::vector<data::Event> events{{"LHS", "", 2.0}, {"LHS", "", 2.2}, {"LTO", "", 2.6},
                                        {"LTO", "", 2.7}, {"RHS", "", 2.5}, {"RHS", "", 3.5}};
  const auto found = events_of_file(events, kFiveSeconds);
  EXPECT_EQ(found.events.size(), 4u);
  ASSERT_EQ(found.notes.size(), 3u);
  EXPECT_EQ(found.notes[0],
            "the file's event Left Foot Strike at 2.200 s follows another of its kind, with no Foot Off "
            "between, and is left out");
  EXPECT_EQ(found.notes[1],
            "the file's event Left Foot Off at 2.700 s follows another of its kind, with no Foot Strike "
            "between, and is left out");
  EXPECT_EQ(
      found.notes[2],
      "no Right Foot Off is labelled between the file's event Right Foot Strike at 2.500 s and the next at "
      "3.500 s")
      << "a file that labels offs labels those of both feet";
}

TEST(FileEventTurns, WhereNoOffIsLabelledNoneIsMissedAndNoStrikeComesTwice) {
  const auto found = events_of_file(
      std::vector<data::Event>{{"LHS", "", 2.0}, {"LHS", "", 3.0}, {"LHS", "", 3.2}, {"RHS", "", 2.5}},
      kFiveSeconds);
  EXPECT_EQ(found.events.size(), 3u);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_EQ(found.notes[0],
            "the file's event Left Foot Strike at 3.200 s follows another of its kind, with no Foot Off "
            "between, and "
            "is left out");
}

TEST(FileEventTurns, OneThatIsNotLabelledIsSaidAndItsNeighboursStand) {
  const std::vector<data::Event> events{
      {"RHS", "", 1.5}, {"RHS", "", 2.6}, {"RTO", "", 3.3}, {"RTO", "", 4.4}, {"RTO", "", 4.5}};
  const auto found = events_of_file(events, kFiveSeconds);
  ASSERT_EQ(found.events.size(), 4u);
  EXPECT_EQ(found.events[1].time_s, 2.6);
  EXPECT_EQ(found.events[3].time_s, 4.4);
  ASSERT_EQ(found.notes.size(), 3u);
  EXPECT_EQ(
      found.notes[0],
      "no Right Foot Off is labelled between the file's event Right Foot Strike at 1.500 s and the next "
      "at 2.600 s");
  EXPECT_EQ(
      found.notes[1],
      "no Right Foot Strike is labelled between the file's event Right Foot Off at 3.300 s and the next "
      "at 4.400 s");
  EXPECT_EQ(found.notes[2],
            "the file's event Right Foot Off at 4.500 s follows another of its kind, with no Foot Strike "
            "between, and is left out");
}

}  // namespace
}  // namespace kinemark::analysis
