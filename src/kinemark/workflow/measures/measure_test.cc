// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/measure.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::workflow {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Four seconds of a hand on a circle of 0.2 m, once a second, under noise of 0.3 mm.
data::Recording circle() {
  auto markers = data::Trajectories::all_missing({"hand"}, {.rate_hz = 100.0, .frames = 400});
  Random random(7, 0);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(f) / 100.0;
    markers.x(f, 0) = Eigen::Vector3d(0.2 * std::cos(turn), 0.2 * std::sin(turn), 1.0);
    for (int axis = 0; axis < 3; ++axis) markers.x(f, 0)[axis] += 3e-4 * random.gaussian();
    markers.state[markers.index(f, 0)] = data::SampleState::measured;
  }
  return {.trial = {.markers = std::move(markers)}};
}

const data::Measure* find(const Measured& found, const std::string& id) {
  const auto one = std::ranges::find(found.measures, id, &data::Measure::id);
  return one == found.measures.end() ? nullptr : &*one;
}

TEST(Measure, APathInMemoryHasItsMeasuresWithIntervals) {
  const auto recording = circle();
  MeasureOptions options;
  options.measures = {"path_length"};
  const auto found = measure(recording, options).value();
  const auto* length = find(found, "path_length");
  ASSERT_NE(length, nullptr);
  const double truth = 2.0 * std::numbers::pi * 0.2 * (length->end_s - length->start_s);
  EXPECT_NEAR(length->value, truth, 0.003 * truth);
  EXPECT_LT(length->interval.low, length->interval.high);
  EXPECT_EQ(found.noises.size(), 1U);
  EXPECT_FALSE(found.gait.has_value());
  EXPECT_EQ(recording.trial.markers.x(5, 0), found.recording.trial.markers.x(5, 0));
}

TEST(Measure, WhatTheCalibrationLeavesUnknownIsSaidAndHeld) {
  auto recording = circle();
  MeasureOptions options;
  options.measures = {"circle_diameter"};
  const auto without = measure(recording, options).value();
  auto& error = recording.trial.calibration_error;
  error = {
      .middle_in_world = {0.0, 0.0, 1.0}, .scale_m = 1.0, .fields = {data::CalibrationError::Field::Zero()}};
  error.fields[0](0, 2) = 4e-4;  // up and down alike, which moves no diameter
  const auto with = measure(recording, options).value();
  EXPECT_THAT(with.remarks.warnings,
              Contains("Intervals hold what the calibration leaves unknown of all positions: 0.4 mm (RMS)"));
  EXPECT_THAT(
      without.remarks.warnings,
      Not(Contains(HasSubstr("Intervals hold what the calibration leaves unknown of all positions:"))));
  options.refits = 0;
  EXPECT_THAT(measure(recording, options).value().remarks.warnings,
              Not(Contains(HasSubstr("Intervals hold what the calibration leaves unknown"))));
}

TEST(Measure, RegionsAreThoseOfTheEditsAndOfTheOptions) {
  auto recording = circle();
  recording.edits.regions = {{.name = "first", .first_frame = 0, .last_frame = 99}};
  MeasureOptions options;
  options.measures = {"path_length"};
  options.regions = {"second=100-199"};
  options.refits = 0;
  const auto found = measure(recording, options).value();
  std::vector<std::string> regions;
  for (const auto& one : found.measures) regions.push_back(one.region);
  EXPECT_THAT(regions, AllOf(Contains("first"), Contains("second")));
  options.regions = {"never"};
  EXPECT_EQ(measure(recording, options).error().code, Code::usage);
}

TEST(Measure, WhatIsNotThereIsAFailureOrARemark) {
  const auto recording = circle();
  EXPECT_EQ(gait(recording).error().code, Code::bad_input) << "a hand does not walk";
  EXPECT_EQ(emg(recording).error().code, Code::bad_input) << "no channels";
  MeasureOptions options;
  options.measures = {"path_length", "cadence", "emg_rms"};
  options.refits = 0;
  const auto found = measure_recording(recording, asked_measures(options).value()).value();
  EXPECT_THAT(found.remarks.warnings, AllOf(Contains(HasSubstr("Walking is not measured: ")),
                                            Contains(HasSubstr("EMG are not measured: "))));
  options.measures = {"path_length"};
  EXPECT_THAT(measure_recording(recording, asked_measures(options).value()).value().remarks.warnings,
              Not(Contains(HasSubstr("not measured"))));
}

TEST(Measure, PointsThatAreNoMarkersAreNotMeasured) {
  auto recording = circle();
  auto& markers = recording.trial.markers;
  const auto only_hand = markers;
  markers = data::Trajectories::all_missing({"LFEA", "hand", "*3"}, only_hand.time);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      markers.x(f, m) = only_hand.x(f, 0) + Eigen::Vector3d(0.0, 0.0, 0.1 * static_cast<double>(m));
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  MeasureOptions options;
  options.measures = {"path_length"};
  options.refits = 0;
  const auto found = measure(recording, options).value();
  ASSERT_EQ(found.measures.size(), 1U);
  EXPECT_EQ(found.measures[0].subject, "hand");
  EXPECT_THAT(found.remarks.warnings,
              Contains("No markers, and not measured unless they are selected alone: 1 computed point (LFEA) "
                       "and 1 without a name"));
  const auto alone = measure(circle(), options).value();
  EXPECT_THAT(alone.remarks.warnings,
              Not(Contains(HasSubstr("No markers, and not measured unless they are selected alone"))));
}

TEST(Measure, EventsOfTheMarkersOwnMovements) {
  MeasureOptions options;
  options.refits = 0;
  options.needs = {.own_movements = true};
  const auto found = measure(circle(), options).value();
  ASSERT_EQ(found.rhythms.size(), 1U);
  EXPECT_TRUE(found.rhythms[0].periodic);
  options.needs = {};
  EXPECT_THAT(measure(circle(), options).value().rhythms, IsEmpty());
}

TEST(Gait, SidesThatAreExchangedMissABound) {
  const analysis::testing::KnownWalk walk;
  data::Recording recording{.trial = {.markers = walk.body_markers(0.0003, 3)}};
  MeasureOptions options;
  options.refits = 0;
  EXPECT_THAT(gait(recording, options).value().remarks.gates, IsEmpty());
  for (auto& name : recording.trial.markers.names)
    if (name.front() == 'L' || name.front() == 'R') name.front() = name.front() == 'L' ? 'R' : 'L';
  const auto found = gait(recording, options).value();
  ASSERT_EQ(found.remarks.gates.size(), 1U);
  EXPECT_FALSE(found.remarks.gates[0].passed);
  EXPECT_THAT(found.remarks.gates[0].sentence, HasSubstr("What this rests on is contradicted: the left "));
}

TEST(Measure, WhatWasFoundOnTheWayInMissesABound) {
  MeasureOptions options;
  options.refits = 0;
  auto recording = circle();
  EXPECT_THAT(measure(recording, options).value().remarks.gates, IsEmpty());
  recording.contradicted = {"the recording shows a mirrored body"};
  const auto found = measure(recording, options).value();
  ASSERT_EQ(found.remarks.gates.size(), 1U);
  EXPECT_EQ(found.remarks.gates[0].name, "contradictions");
  EXPECT_FALSE(found.remarks.passed());
}

}  // namespace
}  // namespace kinemark::workflow
