// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/track.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

struct Followed {
  model::Model model = model::Model::compile(pipeline::human_model().value()).value();
  simulation::SimulatedSubject subject =
      simulation::simulate_subject(model, {.duration_s = 0.5, .rate_hz = 60.0, .seed = 3}).value();
  data::Recording recording{.trial = {.markers = subject.markers}};
};

TEST(Track, FollowsTheMarkersAndSaysHowWell) {
  const Followed followed;
  const auto found = track(followed.model, followed.recording).value();
  const auto& motion = found.result.motion;
  ASSERT_EQ(motion.frames(), followed.recording.trial.markers.frames());
  EXPECT_EQ(motion.tau_sd.size(), motion.tau.size());
  EXPECT_TRUE(found.remarks.passed());
  ASSERT_TRUE(found.used.has_value());
  EXPECT_EQ(found.used->names, motion.markers);
  const auto strict = track(followed.model, followed.recording, {.bounds = {.max_rms_m = 1e-6}}).value();
  EXPECT_FALSE(strict.remarks.passed());
}

TEST(Track, AnExpectedAccuracyIsThatOfTheModelAndSaidWhereMarkersLieFarFromIt) {
  Followed followed;
  TrackOptions options;
  options.track.accuracy_rad = 0.1;
  options.track.marker_noise_sd_m = 0.002;
  const auto near = track(followed.model, followed.recording, options).value();
  ASSERT_TRUE(near.result.accuracy.has_value());
  EXPECT_EQ(near.result.accuracy->noise_sd_m, 0.002);
  EXPECT_THAT(near.remarks.warnings, Not(Contains(HasSubstr("put into the angles is not in it"))));
  auto& markers = followed.recording.trial.markers;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m))
        markers.x(f, m) += 0.02 * (m % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::UnitX();
  EXPECT_THAT(track(followed.model, followed.recording, options).value().remarks.warnings,
              Contains(HasSubstr("what the model's sizes and skin put into the angles is not in it")));
}

TEST(Track, WhatTheCalibrationLeavesUnknownWidensDeviationsAndBounds) {
  Followed followed;
  auto& error = followed.recording.trial.calibration_error;
  const std::string other = followed.recording.trial.markers.names.front();
  for (const auto& levels : {std::vector<motion::TrackLevel>{},
                             std::vector<motion::TrackLevel>{{.markers = {other}}, {.markers = {"*"}}}}) {
    TrackOptions options;
    options.track.levels = levels;
    error.fields.clear();
    const auto without = track(followed.model, followed.recording, options).value();
    error.fields = {data::CalibrationError::Field::Zero()};
    error.fields[0](0, 0) = 2e-3;  // the whole room alike, which moves the root alone
    const auto with = track(followed.model, followed.recording, options).value();
    EXPECT_THAT(without.remarks.warnings,
                Not(Contains(HasSubstr("Deviations of coordinates hold what the calibration"))));
    EXPECT_THAT(with.remarks.warnings, Contains("Deviations of coordinates hold what the calibration leaves "
                                                "unknown of all positions: 2 mm (RMS)"));
    const auto &a = without.result.motion, &b = with.result.motion;
    const auto forward = a.index(15, a.find("pelvis_tx")), knee = a.index(15, a.find("knee_angle_r"));
    EXPECT_NEAR(b.q_sd[forward], std::hypot(a.q_sd[forward], 2e-3), 1e-6);
    EXPECT_NEAR(b.q_bound[forward] - a.q_bound[forward], 5.0 * (b.q_sd[forward] - a.q_sd[forward]), 1e-9);
    EXPECT_NEAR(b.q_sd[knee], a.q_sd[knee], 1e-6);
    options.track.error_bars = false;
    EXPECT_THAT(track(followed.model, followed.recording, options).value().remarks.warnings,
                Not(Contains(HasSubstr("Deviations of coordinates hold what the calibration"))));
  }
}

TEST(Track, ProposedLevelsWeighInTheCalibrationsPartAsTheSameLevelsThatAreGiven) {
  Followed followed;
  auto& error = followed.recording.trial.calibration_error;
  error.fields = {data::CalibrationError::Field::Zero()};
  error.fields[0](1, 0) = error.fields[0](2, 1) = 0.02;  // grows over the room: moves the joints
  TrackOptions options;
  options.track.propose_levels = true;
  const auto proposed = track(followed.model, followed.recording, options).value();
  ASSERT_TRUE(proposed.result.proposed);
  ASSERT_GT(proposed.result.levels.size(), 1U);
  options.track.propose_levels = false;
  options.track.levels = proposed.result.proposed->levels;
  const auto given = track(followed.model, followed.recording, options).value();
  const auto &a = proposed.result.motion, &b = given.result.motion;
  for (std::size_t i = 0; i < a.q_sd.size(); ++i)
    if (a.determined[i] != 0) ASSERT_EQ(a.q_sd[i], b.q_sd[i]) << i;
}

TEST(Track, WithForcesTorquesAreThoseOfTheMotionAndTheForces) {
  Followed followed;
  const auto& time = followed.recording.trial.markers.time;
  data::Wrench push{.name = "plate 1"};
  for (std::int64_t f = 0; f < time.frames; ++f) {
    push.force.insert(push.force.end(), {0.0, 700.0, 0.0});
    push.moment.insert(push.moment.end(), {0.0, 0.0, 0.0});
    push.point.insert(push.point.end(), {0.0, 0.0, 0.0});
  }
  const auto without = track(followed.model, followed.recording).value();
  EXPECT_TRUE(without.torques.facts.empty());
  followed.recording.plates = data::Wrenches{.time = time, .items = {push}};
  const auto with = track(followed.model, followed.recording).value();
  EXPECT_EQ(with.result.motion.q, without.result.motion.q) << "what is followed are markers";
  EXPECT_FALSE(with.torques.facts.empty());
}

TEST(Track, WhatCannotBeFollowedIsSaid) {
  const Followed followed;
  TrackOptions options;
  options.track.levels = {{.markers = {"nobody"}, .tasks = {}}};
  EXPECT_FALSE(track(followed.model, followed.recording, options));
}

}  // namespace
}  // namespace kinemark::workflow
