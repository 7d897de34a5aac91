// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/moving_joint.h"

#include <gtest/gtest.h>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using testing_leg::leg;

constexpr int kHip = 1;

/// The hip lies this far forward in even frames and as far back in odd ones.
data::Trajectories jumping_hip(double by_m, double noise_m) {
  auto forward = leg(), back = leg();
  forward.joints[kHip].parent_from_joint.translation.x() += by_m;
  back.joints[kHip].parent_from_joint.translation.x() -= by_m;
  auto out = testing_leg::record(forward, {.frames = 100, .noise_sd_m = noise_m});
  const auto other = testing_leg::record(back, {.frames = 100, .noise_sd_m = noise_m, .seed = 2});
  for (std::int64_t f = 1; f < out.frames(); f += 2)
    for (std::int64_t m = 0; m < out.markers(); ++m) out.x(f, m) = other.x(f, m);
  return out;
}

JointShift shift_of_hip(double by_m, double noise_m) {
  const auto recording = jumping_hip(by_m, noise_m);
  const auto solved = testing_leg::solve(leg(), recording);
  return measure_shift(solved.problem, recording, solved.states, kHip, std::max(noise_m, 1e-4));
}

TEST(MeasureShift, finds_how_far_a_joint_moves_in_its_parent) {
  EXPECT_NEAR(shift_of_hip(0.01, 0.0).rms_m, 0.01, 0.0005);
  EXPECT_NEAR(shift_of_hip(0.004, 0.0).rms_m, 0.004, 0.0002);
}

TEST(MeasureShift, says_what_noise_alone_makes) {
  const JointShift noisy = shift_of_hip(0.0, 0.002);
  EXPECT_NEAR(noisy.rms_m, noisy.by_noise_m, 0.15 * noisy.by_noise_m);
  EXPECT_LT(shift_of_hip(0.0, 0.0).rms_m, 1e-6);
}

TEST(MeasureShift, a_recording_without_markers_has_none) {
  auto recording = jumping_hip(0.01, 0.0);
  const auto solved = testing_leg::solve(leg(), recording);
  for (std::int64_t f = 0; f < recording.frames(); ++f)
    for (std::int64_t m = 0; m < recording.markers(); ++m) recording.set_missing(f, m);
  EXPECT_EQ(measure_shift(solved.problem, recording, solved.states, kHip, 0.001).rms_m, 0.0);
}

TEST(RecommendJoints, a_shoulder_that_moves_in_a_rigid_trunk_asks_for_clavicles) {
  auto arm = leg();
  arm.bodies[0].name = "torso";
  arm.bodies[1].name = "humerus_r";
  const auto say = [&](double by_m) {
    const auto recording = jumping_hip(by_m, 0.001);
    const auto solved = testing_leg::solve(arm, recording);
    return recommend_joints(solved.problem, recording, solved.states, 0.001);
  };
  const auto sentences = say(0.015);
  ASSERT_EQ(sentences.size(), 1U);
  EXPECT_EQ(sentences[0],
            "the shoulder of 'humerus_r' moves by 15 mm RMS in 'torso', which holds it fixed: give the "
            "model clavicles");
  EXPECT_TRUE(say(0.004).empty());
  arm.bodies[0].name = "clavicle_r";  // it moves already
  EXPECT_TRUE(say(0.015).empty());
}

}  // namespace
}  // namespace kinemark::motion::internal
