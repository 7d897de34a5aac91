// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/event_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

#include "kinemark/core/units.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class GaitCyclesTest : public ::testing::Test {
 protected:
  // A motion of 0 to 3 s at 10 Hz; every column is begin + slope * time.
  std::filesystem::path motion(const std::string& name, const std::string& in_degrees, double begin,
                               double slope, const std::string& columns, int count, int rows = 31) {
    const auto path = scratch_ / name;
    std::ofstream out(path);
    out << "motion\nversion=1\nnRows=" << rows << "\nnColumns=" << count + 1 << "\n"
        << in_degrees << "endheader\ntime" << columns << "\n";
    for (int r = 0; r < rows; ++r) {
      out << 0.1 * r;
      for (int k = 0; k < count; ++k) out << "\t" << begin + slope * 0.1 * r;
      out << "\n";
    }
    return path;
  }

  testing_support::ScratchFolder scratch_;
  std::vector<analysis::GaitCycle> cycles_{{.side = data::Side::left, .start_s = 0.5, .end_s = 1.5},
                                           {.side = data::Side::left, .start_s = 1.5, .end_s = 2.5},
                                           {.side = data::Side::right, .start_s = 1.0, .end_s = 2.0}};
};

TEST_F(GaitCyclesTest, OfAMotionAreCutByTheFootOfTheirName) {
  const auto path = motion("q.mot", "inDegrees=yes\n", 10.0, 1.0,
                           "\tknee_angle_l\tknee_angle_r\tpelvis_tilt\tpelvis_tx", 4);
  const auto curves = gait_curves({}, cycles_, path);
  ASSERT_TRUE(curves) << curves.error().message;
  std::vector<std::string> names;
  for (const auto& one : *curves)
    names.push_back(one.id + " " + one.context + " " + std::to_string(one.count()));
  EXPECT_THAT(names, ElementsAre("knee_angle_l Left 2", "knee_angle_r Right 1", "pelvis_tilt Left 2",
                                 "pelvis_tilt Right 1", "pelvis_tx Left 2", "pelvis_tx Right 1"));
  // Linear in time: 10 + time, in degrees; in the middle of the second left cycle at 2 s.
  EXPECT_NEAR((*curves)[0](1, 50), 12.0 * kRadPerDeg, 1e-9);
  EXPECT_NEAR((*curves)[1](0, 0), 11.0 * kRadPerDeg, 1e-9);
  EXPECT_NEAR((*curves)[5](0, 100), 12.0, 1e-9);  // m, whatever angles are in
  EXPECT_EQ((*curves)[5].quantity, data::Quantity::length);
  EXPECT_TRUE((*curves)[0].sd.empty());
}

TEST_F(GaitCyclesTest, RadiansAreTheSameAnglesAsDegrees) {
  const auto degrees =
      gait_curves({}, cycles_, motion("d.mot", "inDegrees=yes\n", 90.0, 18.0, "\thip_flexion_r", 1));
  const auto radians = gait_curves(
      {}, cycles_,
      motion("r.mot", "inDegrees=no\n", 90.0 * kRadPerDeg, 18.0 * kRadPerDeg, "\thip_flexion_r", 1));
  ASSERT_TRUE(degrees && radians);
  for (std::int64_t p = 0; p < 101; ++p)
    EXPECT_NEAR((*degrees)[0](0, p), (*radians)[0](0, p), 1e-5);  // six digits in the file
}

TEST_F(GaitCyclesTest, DeviationsBesideAMotionBelongToItsCurves) {
  const auto path = motion("q.mot", "inDegrees=yes\n", 10.0, 1.0, "\tknee_angle_l\tpelvis_tx", 2);
  motion("q_sd.sto", "inDegrees=yes\n", 2.0, 0.0, "\tknee_angle_l", 1);
  const auto curves = gait_curves({}, cycles_, path).value();
  ASSERT_EQ(curves[0].sd.size(), 2u * 101u);
  EXPECT_TRUE(curves[1].sd.empty());  // the deviations have no such column
  EXPECT_THAT(curves_csv({{"", {curves[0]}}}, {.file = "q.mot"}),
              HasSubstr("q.mot,,,,,knee_angle_l,Left,,2,50,12,2,,deg\n"));
  EXPECT_TRUE(curves[0].validate());
  // Deviations of another length are of another motion.
  motion("q_sd.sto", "inDegrees=yes\n", 2.0, 0.0, "\tknee_angle_l", 1, 12);
  EXPECT_TRUE(gait_curves({}, cycles_, path).value()[0].sd.empty());
}

TEST_F(GaitCyclesTest, ATableHasEmptyCellsForWhatIsMissingAndQuotesNames) {
  data::CycleCurves curve{.id = "knee, left", .context = "Left", .points = 3, .cycles = {"Left 1", "Left 2"}};
  curve.values = {0.1, kNaN, 0.3, 0.3, kNaN, 0.5};
  for (double& value : curve.values) value *= kRadPerDeg;
  const RecordingName name{.file = "a.c3d", .participant = "sub-1", .trial = "a", .more = {{"sex", "F"}}};
  const std::string columns =
      "file,participant,session,trial,subject,curve,context,region,cycle,percent,value,sd,sd_between,unit,"
      "sex\n";
  EXPECT_EQ(curves_csv({{"all", {curve}}}, name),
            columns +
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,1,0,0.1,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,1,50,,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,1,100,0.3,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,2,0,0.3,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,2,50,,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,2,100,0.5,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,mean,0,0.2,,0.141421356,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,mean,50,,,,deg,F\n"
                "a.c3d,sub-1,,a,,\"knee, left\",Left,all,mean,100,0.4,,0.141421356,deg,F\n");
  EXPECT_EQ(curves_csv({}, name), columns);
}

TEST_F(GaitCyclesTest, TheMeanHasANoiseOfItsOwnBesideWhatDiffersBetweenCycles) {
  data::CycleCurves curve{.id = "speed",
                          .subject = "RFIN",
                          .context = "cycle",
                          .quantity = data::Quantity::speed,
                          .points = 2,
                          .cycles = {"cycle 1", "cycle 2"},
                          .values = {1.0, 2.0, 1.2, 2.0},
                          .sd = {0.03, 0.02, 0.04, kNaN}};
  const auto text = curves_csv({{"", {curve}}}, {.file = "a.c3d"});
  EXPECT_THAT(text, HasSubstr("a.c3d,,,,RFIN,speed,cycle,,1,0,1000,30,,mm/s\n"));
  EXPECT_THAT(text, HasSubstr("a.c3d,,,,RFIN,speed,cycle,,mean,0,1100,25,141.421356,mm/s\n"));
  EXPECT_THAT(text, HasSubstr("a.c3d,,,,RFIN,speed,cycle,,mean,100,2000,,0,mm/s\n"));
}

TEST_F(GaitCyclesTest, RefuseWhatCannotBeCut) {
  const auto path = motion("q.mot", "inDegrees=yes\n", 10.0, 1.0, "\tknee_angle_l", 1);
  const auto none = gait_curves({}, {}, path);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_EQ(none.error().message, "there is no cycle from strike to strike");
  EXPECT_EQ(gait_curves({}, cycles_, {}).error().message,
            "the recording holds no angles to cut into cycles of walking; need --angles FILE.mot, or "
            "--events movement "
            "for the markers' own movements");
  const auto absent = gait_curves({}, cycles_, scratch_ / "absent.mot");
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().message, HasSubstr("absent.mot"));
}

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
