// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/clean/clean.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinemark/core/random.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNoise = 5e-4;

Eigen::Vector3d truth(std::int64_t f, std::int64_t m) {
  const double t = static_cast<double>(f) / 100.0, phase = static_cast<double>(m);
  return {0.2 * std::sin(6.0 * t + phase), 0.1 * std::cos(4.0 * t), 1.0 + 0.05 * phase};
}

/// Two markers for three seconds under white noise; the first is lost for a tenth of a second.
data::Recording noisy() {
  auto markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 300});
  Random random(3, 0);
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      markers.x(f, m) = truth(f, m);
      for (int axis = 0; axis < 3; ++axis) markers.x(f, m)[axis] += kNoise * random.gaussian();
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  for (std::int64_t f = 100; f < 110; ++f) markers.set_missing(f, 0);
  return {.trial = {.markers = std::move(markers)}};
}

double rms_error(const data::Trajectories& markers) {
  double squares = 0.0;
  for (std::int64_t f = 20; f < 280; ++f) squares += (markers.x(f, 1) - truth(f, 1)).squaredNorm() / 3.0;
  return std::sqrt(squares / 260.0);
}

TEST(Clean, SmoothsWhatIsThereAndGivesRates) {
  const auto recording = noisy();
  const auto cleaned = clean(recording).value();
  EXPECT_LT(rms_error(cleaned.recording.trial.markers), 0.7 * rms_error(recording.trial.markers));
  EXPECT_EQ(cleaned.account.names, recording.trial.markers.names);
  EXPECT_EQ(cleaned.account.markers.size(), 2U);
  EXPECT_EQ(cleaned.derivatives.velocity.size(), recording.trial.markers.x_in_world.size());
  EXPECT_FALSE(cleaned.recording.trial.markers.present(105, 0)) << "gaps stay unless they are to be filled";
  EXPECT_THAT(cleaned.remarks.warnings, IsEmpty());
}

TEST(Clean, WhatWasFoundOnTheWayInMissesABound) {
  auto recording = noisy();
  EXPECT_TRUE(clean(recording).value().remarks.passed());
  recording.contradicted = {"the recording shows a mirrored body"};
  const auto cleaned = clean(recording).value();
  ASSERT_EQ(cleaned.remarks.gates.size(), 1U);
  EXPECT_EQ(cleaned.remarks.gates[0].name, "contradictions");
  EXPECT_FALSE(cleaned.remarks.passed());
}

TEST(Clean, PointsThatAreNoMarkersStayAsTheyAre) {
  auto recording = noisy();
  recording.trial.markers.names[0] = "RHJC";
  CleanOptions options;
  options.repair.gaps.method = trajectory::GapMethod::cubic;
  const auto cleaned = clean(recording, options).value();
  const auto& markers = cleaned.recording.trial.markers;
  EXPECT_EQ(markers.x(50, 0), recording.trial.markers.x(50, 0));
  EXPECT_NE(markers.x(50, 1), recording.trial.markers.x(50, 1));
  EXPECT_FALSE(markers.present(105, 0)) << "its gap is nobody's to fill";
  EXPECT_THAT(cleaned.account.gaps, IsEmpty());
  EXPECT_EQ(cleaned.account.markers[0].used.method, "none");
  EXPECT_THAT(
      cleaned.remarks.warnings,
      Contains("No markers, and left as they are unless they are selected alone: 1 computed point (RHJC)"));
  recording.trial.markers.names[1] = "LHJC";
  const auto alone = clean(recording, options).value();
  EXPECT_TRUE(alone.recording.trial.markers.present(105, 0)) << "no marker is left beside them";
  EXPECT_THAT(alone.remarks.warnings,
              Not(Contains(HasSubstr("No markers, and left as they are unless they are selected alone"))));
}

TEST(Clean, FillsGapsWhereThatIsAskedFor) {
  CleanOptions options;
  options.repair.gaps.method = trajectory::GapMethod::cubic;
  const auto cleaned = clean(noisy(), options).value();
  EXPECT_TRUE(cleaned.recording.trial.markers.present(105, 0));
  ASSERT_EQ(cleaned.account.gaps.size(), 1U);
  const auto repaired = repair(noisy(), options.repair).value();
  EXPECT_FALSE(repaired.before.present(105, 0));
  EXPECT_TRUE(repaired.recording.trial.markers.present(105, 0));
  EXPECT_TRUE(repaired.account.markers.empty()) << "nothing is smoothed yet";
  options.repair.gaps.max_gap_s = -1.0;
  EXPECT_EQ(repair(noisy(), options.repair).error().code, Code::usage);
}

TEST(Clean, ARecordingThatWasSmoothedIsSmoothedAnewFromItsOwnSamples) {
  const auto first = clean(noisy()).value();
  const auto again = clean(first.recording).value();
  EXPECT_THAT(again.remarks.warnings, Contains(HasSubstr("smoothed anew from those")));
  const auto &a = first.recording.trial.markers, &b = again.recording.trial.markers;
  for (std::int64_t f = 0; f < 300; f += 7) EXPECT_LT((a.x(f, 1) - b.x(f, 1)).norm(), 1e-12) << f;
  auto kept = first.recording.trial.markers;
  kept.unfiltered_in_world.clear();
  EXPECT_THAT(begin_unfiltered(kept, true), HasSubstr("so that it is smoothed twice"));
  auto raw = noisy().trial.markers;
  EXPECT_EQ(begin_unfiltered(raw, true), "");
}

}  // namespace
}  // namespace kinemark::workflow
