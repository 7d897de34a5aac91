// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/step_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/data/motion_coordinates.h"
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

TEST(StepError, TheStepThatDoesCostsNoMore) {
  const auto model = subject();
  const auto motion = swinging(model, 1e-3);
  const double step_s = step_for(model, motion, 1e-5);
  EXPECT_LE(step_error(model, motion, step_s, 0.5 / step_s), 1e-5);
  const double parts = 0.01 / step_s, longer_s = 0.01 / (std::round(parts) - 1.0);
  EXPECT_NEAR(parts, std::round(parts), 1e-9);
  EXPECT_GT(step_error(model, motion, longer_s, 0.5 / longer_s), 1e-5);
  EXPECT_EQ(step_for(model, motion, 1.0), 0.01) << "a whole frame";
}

TEST(StepError, IsWarnedOfBesideWhatAnglesAreKnownTo) {
  const auto model = subject();
  EXPECT_NE(warn_of_step(model, swinging(model, 5e-4), 0.01, 30.0), "");
  EXPECT_EQ(warn_of_step(model, swinging(model, 1e-2), 0.01, 30.0), "") << "noise is more";
  EXPECT_EQ(warn_of_step(model, swinging(model, 1e-6), 1e-3, 100.0), "") << "nobody needs less than 0.01 deg";
  auto unknown = swinging(model, 5e-4);
  unknown.q_sd.clear();
  EXPECT_EQ(warn_of_step(model, unknown, 0.01, 30.0), "");
}

}  // namespace
}  // namespace kinemark::motion::internal
