// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/state.h"
#include "kinemark/stages/motion/test_body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// Root mean square difference of joint angles (root left out) to the truth, rad, after `skip` frames.
double angle_rms(const model::Model& model, const data::JointMotion& motion, std::int64_t skip = 0) {
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::int64_t f = skip; f < motion.frames(); ++f) {
    const Eigen::VectorXd q = testing_body::coordinates(model, f);
    for (std::int64_t c = 6; c < motion.size(); ++c, ++count)
      squares += std::pow(motion.q[motion.index(f, c)] - q[c], 2);
  }
  return std::sqrt(squares / static_cast<double>(count));
}

TEST(Track, FollowsCleanMarkersToTheTrueAngles) {
  const auto model = body();
  const auto markers = record(model, 150);
  const auto result = track_markers(model, markers);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(angle_rms(model, result->motion), 1e-3);
  EXPECT_LT(result->rms_marker_error_m, 5e-4);
  EXPECT_EQ(result->flagged_frames, 0);
  EXPECT_EQ(result->restarts, 0);
  EXPECT_TRUE(result->locked_coordinates.empty());
  EXPECT_TRUE(result->undetermined_coordinates.empty());
  EXPECT_EQ(result->free_speeds, 12);
  EXPECT_EQ(result->rank, std::vector<int>(150, 12));
  EXPECT_TRUE(result->motion.validate());
  for (const auto status : result->motion.status) EXPECT_EQ(status, data::FrameStatus::converged);
}

TEST(Track, WithNoiseItIsAsGoodAsLeastSquaresOnTheSameGoals) {
  const auto model = body();
  const auto markers = record(model, 300, 1e-3, 4);
  const auto goals = control_goals(markers).value();
  const auto ik = solve_ik(model, goals, {.error_bars = false}).value();
  const auto track = track_markers(model, markers, {.step_s = 1e-3}).value();
  EXPECT_LT(angle_rms(model, track.motion), 1.02 * angle_rms(model, ik.motion));
  EXPECT_LT(track.rms_goal_error_m, 0.7e-3);
}

}  // namespace
}  // namespace kinemark::motion
