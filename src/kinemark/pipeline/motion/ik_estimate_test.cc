// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::pipeline {
namespace {

struct Recorded {
  model::Model model = model::Model::compile(human_model().value()).value();
  simulation::SimulatedSubject subject =
      simulation::simulate_subject(model, {.duration_s = 1.0, .rate_hz = 60.0, .seed = 3}).value();
};

double rms_error(const data::JointMotion& motion, const data::JointMotion& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < motion.q.size(); ++i) squares += std::pow(motion.q[i] - truth.q[i], 2);
  return std::sqrt(squares / static_cast<double>(motion.q.size()));
}

TEST(IkEstimate, TheSmootherBeatsLeastSquaresOnASmoothMotion) {
  const Recorded recorded;
  IkJob job;
  const auto plain = estimate_motion(job, recorded.model, recorded.subject.markers, {}).value().ik;
  EXPECT_TRUE(plain.motion.qd.empty());
  job.estimator = Estimator::smoother;
  const auto smooth = estimate_motion(job, recorded.model, recorded.subject.markers, {}).value().ik;
  EXPECT_EQ(smooth.fit.markers.size(), plain.fit.markers.size());
  EXPECT_EQ(smooth.motion.qd.size(), smooth.motion.q.size());
  EXPECT_GT(smooth.fit.rms_error_m, 0.0);
  EXPECT_LT(rms_error(smooth.motion, recorded.subject.truth),
            0.8 * rms_error(plain.motion, recorded.subject.truth));
}

TEST(IkEstimate, TorquesComeWithEitherEstimator) {
  const Recorded recorded;
  for (const auto estimator : {Estimator::least_squares, Estimator::smoother}) {
    IkJob job;
    job.estimator = estimator;
    job.torques = true;
    const auto estimate = estimate_motion(job, recorded.model, recorded.subject.markers, {}).value();
    const auto& result = estimate.ik;
    ASSERT_EQ(result.motion.tau.size(), result.motion.q.size());
    ASSERT_EQ(result.motion.tau_sd.size(), result.motion.q.size());
    ASSERT_FALSE(estimate.torques.warnings.empty());
    EXPECT_NE(estimate.torques.warnings.back().find("without force plates"), std::string::npos);
    const auto table = torques_table(result.motion);
    EXPECT_EQ(table.rows(), 60);
    EXPECT_EQ(table.columns.size(), result.motion.coordinates.size());
    EXPECT_EQ(table(7, 3), result.motion.tau[result.motion.index(7, 3)]);
    EXPECT_EQ(torque_deviations_table(result.motion)(7, 3), result.motion.tau_sd[result.motion.index(7, 3)]);
    // Somebody carries the weight: along the vertical translation of the root.
    const auto up = result.motion.find("pelvis_ty");
    ASSERT_GE(up, 0);
    EXPECT_EQ(table.columns[static_cast<std::size_t>(up)], "pelvis_ty_force");
    double mean = 0.0;
    for (std::int64_t f = 5; f < 55; ++f) mean += result.motion.tau[result.motion.index(f, up)] / 50.0;
    EXPECT_GT(mean, 100.0);
  }
}

TEST(IkEstimate, WhatTheSmootherCannotDoIsSaid) {
  const Recorded recorded;
  IkJob job;
  job.estimator = Estimator::smoother;
  job.options.loss = motion::Loss::huber;
  EXPECT_FALSE(estimate_motion(job, recorded.model, recorded.subject.markers, {}));
}

}  // namespace
}  // namespace kinemark::pipeline
