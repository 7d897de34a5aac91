// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/ik.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

struct Recorded {
  model::Model model = model::Model::compile(pipeline::human_model().value()).value();
  simulation::SimulatedSubject subject =
      simulation::simulate_subject(model, {.duration_s = 1.0, .rate_hz = 60.0, .seed = 3}).value();
};

double rms_error(const data::JointMotion& motion, const data::JointMotion& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < motion.q.size(); ++i) squares += std::pow(motion.q[i] - truth.q[i], 2);
  return std::sqrt(squares / static_cast<double>(motion.q.size()));
}

/// The markers as a recording that was made in memory.
data::Recording as_recording(const Recorded& recorded) {
  return {.trial = {.markers = recorded.subject.markers}};
}

TEST(Ik, TheSmootherBeatsLeastSquaresOnASmoothMotion) {
  const Recorded recorded;
  const auto recording = as_recording(recorded);
  const auto plain = ik(recorded.model, recording).value().result;
  EXPECT_TRUE(plain.motion.qd.empty());
  const auto smooth = ik(recorded.model, recording, {.estimator = Estimator::smoother}).value().result;
  EXPECT_EQ(smooth.fit.markers.size(), plain.fit.markers.size());
  EXPECT_EQ(smooth.motion.qd.size(), smooth.motion.q.size());
  EXPECT_GT(smooth.fit.rms_error_m, 0.0);
  EXPECT_LT(rms_error(smooth.motion, recorded.subject.truth),
            0.8 * rms_error(plain.motion, recorded.subject.truth));
}

TEST(Ik, WhatTheCalibrationLeavesUnknownWidensEveryEstimator) {
  const Recorded recorded;
  auto recording = as_recording(recorded);
  auto& error = recording.trial.calibration_error;
  for (const auto estimator : {Estimator::least_squares, Estimator::smoother}) {
    error.fields.clear();
    const auto without = ik(recorded.model, recording, {.estimator = estimator}).value();
    error.fields = {data::CalibrationError::Field::Zero()};
    error.fields[0](0, 0) = 2e-3;  // the whole room alike, which moves the root alone
    const auto with = ik(recorded.model, recording, {.estimator = estimator}).value();
    EXPECT_THAT(with.remarks.warnings,
                Contains(HasSubstr("hold what the calibration leaves unknown of all positions: 2 mm (RMS)")));
    EXPECT_THAT(
        without.remarks.warnings,
        Not(Contains(HasSubstr("Deviations of coordinates hold what the calibration leaves unknown of all "
                               "positions:"))));
    const auto &a = without.result.motion, &b = with.result.motion;
    const auto forward = a.index(30, a.find("pelvis_tx")), knee = a.index(30, a.find("knee_angle_r"));
    EXPECT_NEAR(b.q_sd[forward], std::hypot(a.q_sd[forward], 2e-3), 1e-6);
    EXPECT_NEAR(b.q_sd[knee], a.q_sd[knee], 1e-6);
  }
}

TEST(Ik, TorquesComeWithEitherEstimator) {
  const Recorded recorded;
  for (const auto estimator : {Estimator::least_squares, Estimator::smoother}) {
    const auto found =
        ik(recorded.model, as_recording(recorded), {.estimator = estimator, .torques = true}).value();
    const auto& motion = found.result.motion;
    ASSERT_EQ(motion.tau.size(), motion.q.size());
    ASSERT_EQ(motion.tau_sd.size(), motion.q.size());
    EXPECT_THAT(found.remarks.warnings, Contains(HasSubstr("without force plates")));
    // Somebody carries the weight: along the vertical translation of the root.
    const auto up = motion.find("pelvis_ty");
    ASSERT_GE(up, 0);
    double mean = 0.0;
    for (std::int64_t f = 5; f < 55; ++f) mean += motion.tau[motion.index(f, up)] / 50.0;
    EXPECT_GT(mean, 100.0);
  }
}

TEST(Ik, ForcesOfTheRecordingCarryTheWeight) {
  const Recorded recorded;
  auto recording = as_recording(recorded);
  const auto& time = recording.trial.markers.time;
  const double weight_n = 700.0;
  data::Wrench push{.name = "plate 1"};
  for (std::int64_t f = 0; f < time.frames; ++f) {
    push.force.insert(push.force.end(), {0.0, weight_n, 0.0});
    push.moment.insert(push.moment.end(), {0.0, 0.0, 0.0});
    push.point.insert(push.point.end(), {0.0, 0.0, 0.0});
  }
  recording.plates = data::Wrenches{.time = time, .items = {push}};
  const auto with = ik(recorded.model, recording, {.torques = true}).value();
  const auto without = ik(recorded.model, as_recording(recorded), {.torques = true}).value();
  EXPECT_THAT(with.remarks.warnings, Not(Contains(HasSubstr("without force plates"))));
  const auto up = with.result.motion.index(30, with.result.motion.find("pelvis_ty"));
  EXPECT_NEAR(without.result.motion.tau[up] - with.result.motion.tau[up], weight_n, 1e-6 * weight_n);
}

TEST(Ik, WhatItCannotDoIsSaid) {
  const Recorded recorded;
  IkOptions huber{.estimator = Estimator::smoother};
  huber.ik.loss = motion::Loss::huber;
  EXPECT_FALSE(ik(recorded.model, as_recording(recorded), huber));
  const data::ImageTracks images;
  EXPECT_EQ(ik(recorded.model, as_recording(recorded), {.images = &images}).error().code, Code::usage);
}

TEST(Ik, GatesSayHowFarModelAndMarkersAreApart) {
  const Recorded recorded;
  auto recording = as_recording(recorded);
  const auto good = ik(recorded.model, recording).value();
  EXPECT_TRUE(good.remarks.passed());
  EXPECT_EQ(good.used.names, good.result.motion.markers);
  EXPECT_EQ(good.used.frames(), good.result.motion.frames());
  const auto strict = ik(recorded.model, recording, {.bounds = {.max_rms_m = 1e-6}}).value();
  EXPECT_FALSE(strict.remarks.passed());
  EXPECT_EQ(strict.result.motion.q, good.result.motion.q) << "gates judge, they change nothing";
}

}  // namespace
}  // namespace kinemark::workflow
