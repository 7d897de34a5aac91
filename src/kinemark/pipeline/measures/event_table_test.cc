// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/event_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kinemark::pipeline {
namespace {

using data::FootEvent;
using data::Side;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const TimeBase kEventTime{.rate_hz = 100.0, .t0_s = 0.4, .frames = 400, .first_number = 41};

std::vector<EventRow> of_feet() {
  analysis::Gait gait;
  gait.events = {{Side::left, FootEvent::strike, 1.25, 0.006, data::EventSource::plate, "plate 1, east"},
                 {Side::right, FootEvent::off, 1.4, kNaN, data::EventSource::file, "the file"}};
  return events_of(gait, kEventTime);
}

std::vector<analysis::PathRhythm> rhythms() {
  analysis::PathRhythm reach{
      .subject = "RFIN",
      .region = "reach",
      .events = {{analysis::PathEventKind::movement_start, 0.9, 0.004},
                 {analysis::PathEventKind::movement_end, 1.6, kNaN}},
      .verdict = "not periodic: it does not come back to what it did; 1 movement between rests"};
  analysis::PathRhythm circle{.subject = "LFIN",
                              .region = {},
                              .events = {{analysis::PathEventKind::cycle_start, 0.5, 0.001}},
                              .periodic = true,
                              .period_s = 0.8,
                              .verdict = "4 cycles of 0.800 s (likeness 0.99)"};
  return {reach, circle};
}

TEST(EventTable, HasOneRowEach) {
  EXPECT_EQ(events_csv(of_feet(), {.file = "walk.c3d", .participant = "sub-1", .trial = "walk"}),
            "file,participant,session,trial,subject,context,region,label,time_s,frame,sd_s,source,method\n"
            "walk.c3d,sub-1,,walk,,Left,,Foot Strike,1.250000,126,0.006000,plate,\"plate 1, east\"\n"
            "walk.c3d,sub-1,,walk,,Right,,Foot Off,1.400000,141,,file,the file\n");
  EXPECT_EQ(events_csv_rows(events_of(rhythms(), kEventTime), {.file = "a.c3d", .more = {{"age", "3"}}}),
            "a.c3d,,,,RFIN,,reach,Movement Start,0.900000,91,0.004000,kinematics,5 % of the peak speed,3\n"
            "a.c3d,,,,RFIN,,reach,Movement End,1.600000,161,,kinematics,5 % of the peak speed,3\n"
            "a.c3d,,,,LFIN,,,Cycle Start,0.500000,51,0.001000,kinematics,upward crossing of the mean,3\n");
}

TEST(EventTable, ARecordingGetsThemInPlaceOfItsOwnOfTheKind) {
  data::Trial trial;
  trial.markers.time = kEventTime;
  trial.events = {{"jump", "Left", 1.0}, {"Foot Strike", "Left", 1.2}, {"Movement End", "General", 1.3}};
  const auto labels = [](const data::Trial& of) {
    std::vector<std::string> out;
    for (const auto& event : of.events) out.push_back(event.label + " " + event.context);
    return out;
  };
  EXPECT_THAT(labels(with_events(trial, of_feet())),
              ElementsAre("jump Left", "Foot Strike Left", "Movement End General", "Foot Off Right"));
  EXPECT_EQ(with_events(trial, of_feet()).events[1].time_s, 1.25);
  EXPECT_THAT(labels(with_events(trial, events_of({rhythms().front()}, kEventTime))),
              ElementsAre("Movement Start General", "jump Left", "Foot Strike Left", "Movement End General"));
}

TEST(EventTable, SaysToPeopleAndProgramsWhyThereAreNoCycles) {
  const auto text = rhythms_text(rhythms());
  EXPECT_THAT(text, HasSubstr("RFIN, reach: not periodic: it does not come back"));
  EXPECT_THAT(text, HasSubstr("  Movement Start     0.9000 +- 0.0040 s\n"));
  EXPECT_THAT(text, HasSubstr("LFIN: 4 cycles of 0.800 s"));
  const auto json = rhythms_json(rhythms());
  EXPECT_FALSE(json[0]["periodic"].get<bool>());
  EXPECT_TRUE(json[0]["period_s"].is_null());
  EXPECT_TRUE(json[0]["events"][1]["sd_s"].is_null());
  EXPECT_EQ(json[1]["period_s"], 0.8);
  EXPECT_FALSE(json[1].contains("region"));
}

}  // namespace
}  // namespace kinemark::pipeline
