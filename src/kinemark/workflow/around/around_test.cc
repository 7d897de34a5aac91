// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/around/around.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A marker that moves along a line for 10 s, with a foot strike at 5 s and a movement from 3 s.
MovementSession ten_seconds() {
  MovementSession out;
  analysis::SampledCurve x{.subject = "f7", .id = "x"};
  for (int i = 0; i <= 100; ++i) {
    x.time_s.push_back(0.1 * i);
    x.value.push_back(0.01 * i);
  }
  out.curves = {x};
  out.span = {.start_s = 0.0, .end_s = 10.0};
  out.events = {{.label = "Go", .context = "", .time_s = 5.0},
                {.label = "Foot Strike", .context = "Left", .time_s = 6.0}};
  out.movements = {{.name = "f7 Movement Start", .times_s = {3.0}}};
  return out;
}

data::Neural two_units() {
  data::Neural out;
  out.units = {{.id = "1", .labels = {}, .times_s = {1.0, 2.0, 5.05}},
               {.id = "2", .labels = {}, .times_s = {3.05, 9.95}}};
  out.intervals = {{.name = "trials",
                    .rows = {{.start_s = 1.0, .stop_s = 2.0, .labels = {{"side", "left"}}},
                             {.start_s = 5.0, .stop_s = 6.0, .labels = {{"side", "right"}}}}}};
  return out;
}

AroundChoice of(const std::string& what) {
  AroundChoice out;
  out.from_s = -0.1;
  out.to_s = 0.1;
  out.bin_s = 0.1;
  out.what = what;
  return out;
}

std::vector<std::string> events_of(const AroundFound& found) {
  std::vector<std::string> out;
  for (const auto& curve : found.curves) out.push_back(curve.events);
  return out;
}

std::string fault_of(const MovementSession& session, const data::Neural& neural, const AroundChoice& choice) {
  const auto found = around(session, neural, choice);
  return found ? "" : found.error().message;
}

TEST(AroundVerb, SpikesAverageTheMovement) {
  const auto found = around(ten_seconds(), two_units(), of("units"));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(events_of(*found), ElementsAre("unit 1", "unit 2"));
  EXPECT_EQ(found->curves[0].used, 3);
  EXPECT_EQ(found->curves[0].subject, "f7");
  EXPECT_NEAR(found->curves[0].bins[0].mean, 0.1 * (8.05 / 3.0 - 0.05), 1e-12);
  EXPECT_EQ(found->curves[1].outside, 1) << "9.95 s and 0.1 s more";
  EXPECT_THAT(found->remarks.warnings,
              ElementsAre("1 of 5 events are left out: their window leaves the recording"));
  const auto one = around(ten_seconds(), two_units(), of("unit:2"));
  ASSERT_TRUE(one);
  EXPECT_THAT(events_of(*one), ElementsAre("unit 2"));
}

TEST(AroundVerb, EventsAverageTheRates) {
  const auto movement = around(ten_seconds(), two_units(), of("movement"));
  ASSERT_TRUE(movement);
  EXPECT_THAT(events_of(*movement), ElementsAre("f7 Movement Start", "f7 Movement Start"));
  EXPECT_EQ(movement->curves[1].bins[1].mean, 10.0) << "unit 2 fires 50 ms after the start";
  EXPECT_EQ(movement->curves[0].bins[1].mean, 0.0);
  EXPECT_THAT(movement->remarks.warnings,
              Not(Contains(HasSubstr("are left out: their window leaves the recording"))));

  const auto trials = around(ten_seconds(), two_units(), of("trials"));
  ASSERT_TRUE(trials);
  EXPECT_EQ(trials->curves[0].used, 2);
  const auto sides = around(ten_seconds(), two_units(), of("trials:side"));
  ASSERT_TRUE(sides);
  EXPECT_THAT(events_of(*sides),
              ElementsAre("trials side=left", "trials side=left", "trials side=right", "trials side=right"));
  const auto strikes = around(ten_seconds(), two_units(), of("Foot Strike"));
  ASSERT_TRUE(strikes);
  EXPECT_THAT(events_of(*strikes), Contains("Left Foot Strike"));
}

TEST(AroundVerb, WhatDoesNotExistIsNamedWithWhatIsNear) {
  EXPECT_THAT(fault_of(ten_seconds(), two_units(), of("unit:7")),
              HasSubstr("there is no unit '7'; there are 1 and 2"));
  EXPECT_THAT(fault_of(ten_seconds(), two_units(), of("trails")), HasSubstr("nearest: trials"));
  EXPECT_THAT(fault_of(ten_seconds(), two_units(), of("trials:sied")),
              HasSubstr("trials have no column 'sied'; nearest: side"));
  EXPECT_THAT(fault_of(ten_seconds(), two_units(), of("xyzw")), HasSubstr("Foot Strike"));
  auto session = ten_seconds();
  session.movements.clear();
  EXPECT_THAT(fault_of(session, two_units(), of("movement")),
              HasSubstr("no movement starts in the recording"));
  EXPECT_THAT(fault_of(session, {}, of("units")), HasSubstr("there are no units with spikes"));
}

TEST(AroundVerb, SpikesOutsideTheRecordingAreSaid) {
  auto neural = two_units();
  neural.units[0].times_s.push_back(50.0);
  const auto found = around(ten_seconds(), neural, of("movement"));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->remarks.warnings,
              ElementsAre("1 of 6 spikes lie outside the recording (0.000 to 10.000 s) "
                          "and have no movement"));
  const auto whole = around(ten_seconds(), two_units(), of("movement"));
  ASSERT_TRUE(whole);
  EXPECT_THAT(whole->remarks.warnings, Not(Contains(HasSubstr("outside the recording"))));
}

TEST(AroundVerb, TwoClocksAreRefusedAndAnOffsetBringsThemTogether) {
  auto neural = two_units();
  for (auto& unit : neural.units)
    for (double& time : unit.times_s) time += 1000.0;
  EXPECT_THAT(fault_of(ten_seconds(), neural, of("units")),
              HasSubstr("all 5 spikes lie outside the recording: they go from 1001.000 to 1009.950 s"));
  auto choice = of("units");
  choice.clock_offset_s = -1000.0;
  const auto found = around(ten_seconds(), neural, choice);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->curves[0].used, 3);
  auto far = two_units();
  for (auto& row : far.intervals[0].rows) row.start_s += 100.0, row.stop_s += 100.0;
  EXPECT_THAT(
      fault_of(ten_seconds(), far, of("trials")),
      HasSubstr("no event of 'trials' has its whole window in the recording, which lasts from 0.000 to"));
  for (auto& unit : neural.units) unit.times_s.clear();
  EXPECT_EQ(fault_of(ten_seconds(), neural, of("units")), "no unit has a spike");
}

}  // namespace
}  // namespace kinemark::workflow
