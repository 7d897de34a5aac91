// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/accuracy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing_body::angle_rms;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

Result<TrackResult> to_accuracy(const model::Model& model, const data::Trajectories& markers, double deg,
                                TrackOptions options = {}) {
  options.accuracy_rad = kRadPerDeg * deg;
  options.error_bars = false;
  return track_markers(model, markers, options);
}

TEST(Accuracy, WhatIsPromisedIsKeptAndPredicted) {
  const auto model = body();
  for (const double noise_m : {0.3e-3, 2e-3}) {
    const auto markers = record(model, 400, noise_m, 6);
    const auto track = to_accuracy(model, markers, 3.0);
    ASSERT_TRUE(track) << track.error().message;
    const auto& choice = track->accuracy.value();
    const double error = angle_rms(model, track->motion);
    EXPECT_LT(error, choice.wanted_rad);
    EXPECT_NEAR(error / choice.predicted_rad, 1.0, 0.35) << noise_m;
    EXPECT_NEAR(std::pow(choice.predicted_rad, 2),
                std::pow(choice.noise_rad, 2) + std::pow(choice.lost_rad, 2) + std::pow(choice.step_rad, 2),
                1e-12);
    EXPECT_NEAR(choice.omega_rad_s * choice.step_s, 0.5, 1e-12);
    EXPECT_NEAR(track->step_s, choice.step_s, 1e-12);
    EXPECT_GT(choice.largest_rad, choice.smallest_rad);
    EXPECT_NE(choice.largest, choice.smallest);
    EXPECT_GE(choice.largest_rad, choice.noise_rad);
    EXPECT_LE(choice.smallest_rad, choice.predicted_rad);
  }
}

TEST(Accuracy, NoisierMarkersHaveALowerCutOffAndFinerWishesAShorterStep) {
  const auto model = body();
  const auto calm = to_accuracy(model, record(model, 400, 0.1e-3, 6), 3.0).value(),
             noisy = to_accuracy(model, record(model, 400, 3e-3, 6), 3.0).value();
  EXPECT_GT(calm.accuracy->cutoff_hz, noisy.accuracy->cutoff_hz);
  EXPECT_GT(noisy.accuracy->predicted_rad, 3.0 * calm.accuracy->predicted_rad);
  const double floor_deg = kDegPerRad * std::hypot(calm.accuracy->noise_rad, calm.accuracy->lost_rad);
  const auto fine = to_accuracy(model, record(model, 400, 0.1e-3, 6), 1.15 * floor_deg);
  if (fine) EXPECT_LE(fine->accuracy->step_s, calm.accuracy->step_s);
}

TEST(Accuracy, BelowTheNoiseItIsRefusedWithWhatWouldDo) {
  const auto model = body();
  const auto markers = record(model, 400, 2e-3, 6);
  const auto refused = to_accuracy(model, markers, 0.01);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("an accuracy of 0.01 deg cannot be had: "));
  EXPECT_THAT(refused.error().message, HasSubstr(" mm would do, it is "));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("without steps it could: the movement is too fast")));
  EXPECT_THAT(refused.error().message, HasSubstr("Hz instead of 100 Hz"));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("nan")));
}

TEST(Accuracy, WhereStepsAloneAreInTheWayNoLessNoiseIsAskedFor) {
  const auto model = body();
  // Every fourth frame, as if it were the next: a movement four times as fast.
  const auto slow = record(model, 1600);
  auto markers = record(model, 400);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m) = slow.x(4 * f, m);
  const TrackOptions quiet{.marker_noise_sd_m = 1e-6};
  const auto had = to_accuracy(model, markers, 20.0, quiet).value();
  const double floor_deg = kDegPerRad * std::hypot(had.accuracy->noise_rad, had.accuracy->lost_rad);
  const auto refused = to_accuracy(model, markers, 1.1 * floor_deg * (1.0 + 1e-9), quiet);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("without steps it could: the movement is too fast for those"));
  EXPECT_THAT(refused.error().message, Not(HasSubstr(" mm would do, it is ")));
}

TEST(Accuracy, StrictLevelsHaveTheirOwnMatrices) {
  const auto model = body();
  const auto markers = record(model, 300, 1e-3, 6);
  const auto one = to_accuracy(model, markers, 5.0).value();
  const auto strict = to_accuracy(model, markers, 5.0,
                                  {.levels = {{.markers = {"S3", "F2"}}, {.markers = {"*"}}}, .strict = true})
                          .value();
  EXPECT_GT(strict.accuracy->noise_rad, 1.01 * one.accuracy->noise_rad) << "priority has its price";
}

TEST(Accuracy, OfSamplesThatWereSmoothedBeforeItIsNotKnownUnlessTheirNoiseIsGiven) {
  const auto model = body();
  const auto smooth = control_goals(record(model, 400, 2e-3, 6), {.cutoff_hz = 12.0}).value();
  const auto refused = to_accuracy(model, smooth, 2.0);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("the samples show no noise of their own (they were smoothed before"));
  EXPECT_TRUE(to_accuracy(model, smooth, 5.0, {.marker_noise_sd_m = 2e-3}));
}

TEST(Accuracy, IsForRecordingsAndChoosesTheGainsItself) {
  const auto model = body();
  const auto live = OnlineTracker::create(model, {"T1", "T2", "T3", "T4"}, 100.0, {.accuracy_rad = 0.01});
  ASSERT_FALSE(live);
  EXPECT_EQ(live.error().code, Code::usage);
  const auto both = track_markers(model, record(model, 50), {.kp = 100.0, .kd = 20.0, .accuracy_rad = 0.01});
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().message, HasSubstr("an accuracy chooses gains and cut-off"));
  EXPECT_FALSE(track_markers(model, record(model, 50), {.accuracy_rad = -1.0}));
}

}  // namespace
}  // namespace kinemark::motion
