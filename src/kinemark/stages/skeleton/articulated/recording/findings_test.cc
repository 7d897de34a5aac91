// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/findings.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::internal {
namespace {

using data::CentreState;
using testing_limbs::make_random_chain;
using testing_limbs::random_rotation;
using testing_limbs::RandomChain;

ChainFit known_geometry(const RandomChain& limb, double noise_m) {
  ChainFit fit;
  fit.chain = limb.chain;
  fit.noise_sd_m = noise_m;
  fit.marker_weight.assign(static_cast<std::size_t>(limb.chain.markers()), 1.0);
  const auto n = static_cast<Eigen::Index>(limb.chain.globals().size());
  fit.global_covariance = Eigen::MatrixXd::Zero(n, n);
  return fit;
}

/// A joint that takes these turns in turn.
RecordingPass turned(const std::vector<Matrix3d>& child_in_parent) {
  RecordingPass pass;
  Random random(4, 1);
  for (std::size_t i = 0; i < child_in_parent.size(); ++i) {
    const Matrix3d R = random_rotation(random);
    pass.sampled.push_back({.frame = static_cast<std::int64_t>(i),
                            .pose = {.joint0 = Vector3d::Zero(), .rotation = {R, R * child_in_parent[i]}},
                            .cost = 0.0,
                            .known = {1}});
  }
  return pass;
}

Matrix3d about_x(double deg) {
  return Eigen::AngleAxisd(deg * kRadPerDeg, Vector3d::UnitX()).toRotationMatrix();
}

TEST(RecordingPass, EveryFrameOfAnyNumberOfThreadsIsTheSolversOwn) {
  RandomChain limb = make_random_chain({.frames = 60, .missing = 0.3});
  const ChainFit fit = known_geometry(limb, 0.001);
  const RecordingPass one = pass_over(fit, limb.samples, 1, {}).value();
  ChainSolver solver(fit);
  ChainFrame frame;
  std::size_t flagged = 0;
  for (std::size_t f = 0; f < 60; ++f) {
    solver.solve(limb.samples.frame(static_cast<std::int64_t>(f)), nullptr, frame);
    EXPECT_EQ(one.state[0][f], frame.state[0]) << f;
    if (frame.state[0] != CentreState::determined) {
      ASSERT_LT(flagged, one.flagged.size());
      EXPECT_EQ(one.flagged[flagged++].frame, static_cast<std::int64_t>(f));
      EXPECT_TRUE(one.points[0][f].information.isZero(0.0)) << "no place of its own";
    } else {
      EXPECT_LT((one.points[0][f].place - frame.centre[0]).norm(), 1e-7);
      EXPECT_LT((load_symmetric(one.covariance[0].data() + 6 * f) - frame.covariance[0]).norm(), 1e-9);
    }
  }
  EXPECT_EQ(flagged, one.flagged.size());
  EXPECT_TRUE(one.misfits.empty());
}

TEST(RecordingPass, StopsWhenItIsTold) {
  const RandomChain limb = make_random_chain({.frames = 10});
  const auto pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1,
                              [](std::int64_t, std::int64_t) { return false; });
  ASSERT_FALSE(pass.has_value());
  EXPECT_EQ(pass.error().code, Code::cancelled);
}

TEST(RecordingPass, AMarkerElsewhereMakesAMisfit) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 10});
  limb.samples.x[3 * 8 * 6] += 0.03;
  const RecordingPass pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1, {}).value();
  EXPECT_EQ(pass.misfits, std::vector<std::int64_t>{6});
  EXPECT_FALSE(is_misfit(limb.chain, 15e-6, 0.001, 8)) << "15 for 24 - 9 degrees of freedom";
  EXPECT_TRUE(is_misfit(limb.chain, 60e-6, 0.001, 8));
}

TEST(JointMotion, AHingeShowsItsAxisAndItsRange) {
  const RandomChain limb = make_random_chain({.frames = 1});
  std::vector<Matrix3d> turns;
  for (int i = 0; i <= 60; ++i) turns.push_back(about_x(i));
  const auto seen = look_at_joint(known_geometry(limb, 0.0005), turned(turns), 0);
  EXPECT_EQ(seen.frames, 61);
  EXPECT_NEAR(seen.range_rad * kDegPerRad, 60.0, 1e-6);
  EXPECT_TRUE(seen.one_axis);
  EXPECT_FALSE(seen.still);
  EXPECT_NEAR(std::abs(seen.axis_in_parent[0]), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(seen.axis_in_child[0]), 1.0, 1e-9);
  EXPECT_LT(seen.second_rad, 1e-6);
}

TEST(JointMotion, ABallHasNoAxisAndAStillJointNeither) {
  const RandomChain limb = make_random_chain({.frames = 1});
  Random random(6, 1);
  std::vector<Matrix3d> free, still;
  for (int i = 0; i < 60; ++i) {
    free.push_back(random_rotation(random));
    Vector3d v;
    for (int c = 0; c < 3; ++c) v[c] = 0.002 * random.gaussian();
    still.push_back(exponential(v));
  }
  const auto ball = look_at_joint(known_geometry(limb, 0.0005), turned(free), 0);
  EXPECT_FALSE(ball.one_axis);
  EXPECT_FALSE(ball.still);
  EXPECT_GT(ball.range_rad, 2.5);
  const auto none = look_at_joint(known_geometry(limb, 0.0005), turned(still), 0);
  EXPECT_TRUE(none.still);
  EXPECT_FALSE(none.one_axis);
  EXPECT_EQ(look_at_joint(known_geometry(limb, 0.0005), RecordingPass{}, 0).frames, 0);
}

TEST(Slips, AStepInTimeHasItsMarkerItsFrameAndItsSize) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 120});
  const ChainFit fit = known_geometry(limb, 0.001);
  EXPECT_TRUE(find_slips(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value()).empty());
  EXPECT_TRUE(find_loose_markers(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value()).empty());
  for (std::size_t f = 70; f < 120; ++f) {
    const Vector3d off = limb.pose[f].rotation[1] * Vector3d(0.0, 0.0, 0.012);
    for (int i = 0; i < 3; ++i) limb.samples.x[30 * f + 3 * 7 + static_cast<std::size_t>(i)] += off[i];
  }
  const auto slips = find_slips(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value());
  ASSERT_EQ(slips.size(), 1U);
  EXPECT_EQ(slips[0].marker, 7);
  EXPECT_EQ(slips[0].frame, 70);
  EXPECT_NEAR(slips[0].distance_m, 0.010, 0.004) << "its segment's pose follows it a little";
}

TEST(Swaps, TheExchangedPairIsNamed) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 40});
  const ChainFit fit = known_geometry(limb, 0.001);
  for (const std::size_t f : {10U, 11U, 12U})
    for (std::size_t i = 0; i < 3; ++i)
      std::swap(limb.samples.x[24 * f + 3 * 2 + i], limb.samples.x[24 * f + 3 * 5 + i]);
  const auto swaps = find_swaps(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value());
  ASSERT_EQ(swaps.size(), 1U);
  EXPECT_EQ(swaps[0].marker_a, 2);
  EXPECT_EQ(swaps[0].marker_b, 5);
  EXPECT_EQ(swaps[0].first_frame, 10);
  EXPECT_EQ(swaps[0].frames, 3);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
