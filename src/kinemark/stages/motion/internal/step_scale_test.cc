// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/step_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kNoise_m = 0.5e-3;

struct Solved {
  model::Model model = model::Model::compile(testing_body::description()).value();
  data::Trajectories markers = testing_body::record(model, 200, kNoise_m, 3);
  IkOptions options;
  Progress progress;
  Problem problem = make_problem(model, markers, options).value();
  SolvedFrames frames;

  Solved() { EXPECT_TRUE(FrameWalk(problem, options, progress).run(markers, true, frames)); }
};

TEST(StepScale, StepsOfPositionsAreThoseOfTheNoise) {
  const Solved solved;
  const StepScale scale(solved.problem, solved.frames);
  // White noise alone: two samples differ by sqrt(2) of it. The pose takes part of it away.
  for (const double sd : scale.position) {
    EXPECT_GT(sd, 0.5 * std::sqrt(2.0) * kNoise_m);
    EXPECT_LT(sd, 1.3 * std::sqrt(2.0) * kNoise_m);
  }
}

TEST(StepScale, GrowthIsLearntWhenItIsNeededAndOnce) {
  const Solved solved;
  StepScale scale(solved.problem, solved.frames);
  const double after = scale.position_sd_after(0, 64);
  EXPECT_EQ(scale.position_sd_after(0, 1), scale.position[0]);
  EXPECT_GE(after, scale.position_sd_after(0, 4));
  scale.learn_growth();
  EXPECT_EQ(scale.position_sd_after(0, 64), after);
  StepScale early(solved.problem, solved.frames);
  early.learn_growth();
  EXPECT_EQ(early.position_sd_after(0, 64), after) << "learnt before, for streams";
}

}  // namespace
}  // namespace kinemark::motion::internal
