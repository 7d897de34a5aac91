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
