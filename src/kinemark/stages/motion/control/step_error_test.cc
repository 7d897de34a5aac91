// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/step_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/stages/motion/control/internal/followed_run.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kTurns = 2.0 * std::numbers::pi;  // rad/s: once a second
constexpr double kSize = 0.4;

model::Model subject() { return model::Model::compile(testing_body::description()).value(); }

/// All angles swing once a second, known to `sd`.
data::JointMotion swinging(const model::Model& model, double sd) {
  data::JointMotion motion;
  data::set_coordinates(model.description(), motion);
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 201};
  motion.status.assign(201, data::FrameStatus::converged);
  const auto numbers = at(motion.frames() * motion.size());
  motion.q_sd.assign(numbers, sd);
  motion.qdd.assign(numbers, 0.0);
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c)
      motion.qdd[motion.index(f, c)] = -kSize * kTurns * kTurns * std::sin(kTurns * motion.time.time_s(f));
  return motion;
}

TEST(StepError, IsTheFormulaOnAMovementWhoseThirdDerivativeIsKnown) {
  const auto model = subject();
  const auto motion = swinging(model, 1e-3);
  const double third = kSize * std::pow(kTurns, 3) / std::sqrt(2.0);
  const double expected = 2.0 * 0.3 * 0.01 * third / (2.0 * 30.0 * 30.0) * (1.0 - 0.3 / 3.0);
  EXPECT_NEAR(step_error(model, motion, 0.01, 30.0), expected, 0.01 * expected);
  EXPECT_NEAR(stated_error(model, motion), 1e-3, 1e-12);
}

TEST(StepError, FramesInWhichTheBodyWasSetAnewDoNotCount) {
  const auto model = subject();
  auto motion = swinging(model, 1e-3);
  const double before = step_error(model, motion, 0.01, 30.0);
  for (std::int64_t c = 0; c < motion.size(); ++c) motion.qdd[motion.index(100, c)] = 1e6;
  EXPECT_GT(step_error(model, motion, 0.01, 30.0), 10.0 * before);
  motion.status[100] = data::FrameStatus::not_converged;
  EXPECT_NEAR(step_error(model, motion, 0.01, 30.0), before, 0.02 * before);
}

TEST(StepError, TheStepThatDoesIsTheLongestPartThatCostsNoMore) {
  EXPECT_EQ(step_for(0.01, 1e-3, 1e-3), 0.01) << "as it is";
  EXPECT_NEAR(step_for(0.01, 1e-3, 0.9e-3), 0.005, 1e-12);
  EXPECT_NEAR(step_for(0.01, 1e-3, 0.125e-3), 0.005, 1e-12) << "an eighth at half of the step";
  EXPECT_NEAR(step_for(0.01, 1e-3, 0.124e-3), 0.01 / 3.0, 1e-12);
  EXPECT_GT(step_for(0.01, 1.0, 1e-30), 4e-5) << "it ends";
}

TEST(StepError, IsWarnedOfBesideWhatAnglesAreKnownTo) {
  const auto model = subject();
  const Plan plan =
      make_plan(model, testing_body::record(model, 4), {.omega_rad_s = 30.0, .step_s = 0.01}).value();
  EXPECT_NE(warn_of_step(plan, 1.1e-3, 5e-3), "");
  EXPECT_EQ(warn_of_step(plan, 0.9e-3, 5e-3), "") << "noise is more";
  EXPECT_EQ(warn_of_step(plan, 1.7e-4, 1e-6), "") << "nobody needs less than 0.01 deg";
  EXPECT_NE(warn_of_step(plan, 1.8e-4, 1e-6), "");
  auto unknown = swinging(model, 5e-4);
  unknown.q_sd.clear();
  EXPECT_TRUE(std::isnan(stated_error(model, unknown)));
}

TEST(StepError, IsMeasuredByFinerStepsWhateverThePart) {
  const auto model = subject();
  const auto markers = testing_body::record(model, 300);
  const TrackOptions options{.omega_rad_s = 50.0, .step_s = 0.01, .judge_samples = false};
  const Plan plan = make_plan(model, markers, options).value();
  const auto filter = make_filter(100.0, options);
  const auto run = first_run(plan, markers, filter, options, {}).value();
  const Plan finer = with_finer_steps(run.body.plan);
  EXPECT_EQ(finer.steps_per_frame, 4);
  EXPECT_NEAR(std::sqrt(finer.kp), 200.0, 1e-9);
  const auto cost = [&](const Eigen::MatrixXd& states) {
    Walker walker(finer, filter, plan.problem.frames, 0.0);
    fill_window(finer, markers, walker.samples());
    return step_cost(run.body.plan, states, walker);
  };
  const double found = cost(run.body.track.states);
  EXPECT_GT(found, 1e-6);
  EXPECT_LT(found, step_error(model, run.body.result.motion, 0.01, 50.0));
  auto moved = run.body.track.states;
  const int elbow = model.coordinates()[9].state_idx;
  for (Eigen::Index f = 0; f < moved.cols(); ++f) moved(elbow, f) += f % 2 == 0 ? 0.0 : 0.02;
  // One of seven angles is 0.02 off in every other frame.
  EXPECT_NEAR(cost(moved), 0.02 / std::sqrt(12.0), 0.3 * 0.02 / std::sqrt(12.0));
}

}  // namespace
}  // namespace kinemark::motion::internal
