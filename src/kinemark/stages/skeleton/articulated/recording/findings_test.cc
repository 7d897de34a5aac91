// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/findings.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::random_rotation;
using testing_limbs::RandomChain;

/// A joint that takes these turns in turn.
RecordingPass rotated(const std::vector<Matrix3d>& child_in_parent) {
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

TEST(ObservedMotion, AHingeShowsItsAxisAndItsRange) {
  const RandomChain limb = make_random_chain({.frames = 1});
  std::vector<Matrix3d> rotations;
  for (int i = 0; i <= 60; ++i) rotations.push_back(about_x(i));
  const auto seen = observe_motion(known_geometry(limb, 0.0005), rotated(rotations), 0);
  EXPECT_EQ(seen.frames, 61);
  EXPECT_NEAR(seen.range_rad * kDegPerRad, 60.0, 1e-6);
  EXPECT_TRUE(seen.one_axis);
  EXPECT_FALSE(seen.still);
  EXPECT_NEAR(std::abs(seen.axis_in_parent[0]), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(seen.axis_in_child[0]), 1.0, 1e-9);
  EXPECT_LT(seen.second_rad, 1e-6);
}

TEST(ObservedMotion, ABallHasNoAxisAndAStillJointNeither) {
  const RandomChain limb = make_random_chain({.frames = 1});
  Random random(6, 1);
  std::vector<Matrix3d> free, still;
  for (int i = 0; i < 60; ++i) {
    free.push_back(random_rotation(random));
    Vector3d v;
    for (int c = 0; c < 3; ++c) v[c] = 0.002 * random.gaussian();
    still.push_back(math::exp_so3(v));
  }
  const auto ball = observe_motion(known_geometry(limb, 0.0005), rotated(free), 0);
  EXPECT_FALSE(ball.one_axis);
  EXPECT_FALSE(ball.still);
  EXPECT_GT(ball.range_rad, 2.5);
  const auto none = observe_motion(known_geometry(limb, 0.0005), rotated(still), 0);
  EXPECT_TRUE(none.still);
  EXPECT_FALSE(none.one_axis);
  EXPECT_EQ(observe_motion(known_geometry(limb, 0.0005), RecordingPass{}, 0).frames, 0);
}

TEST(ObservedMotion, WithoutAFrameThatDeterminesItNothingIsSaidOfItsMotion) {
  const RandomChain limb = make_random_chain({.frames = 1});
  const FittedChain fit = known_geometry(limb, 0.0005);
  RecordingPass pass = rotated({about_x(0.0), about_x(60.0)});
  EXPECT_EQ(describe_motion(observe_motion(fit, pass, 0), false, 0.002),
            "60 deg of motion: centre known to 2.0 mm in its segments");
  for (auto& pose : pass.sampled) pose.known[0] = false;  // mirrored places in each of them
  EXPECT_EQ(describe_motion(observe_motion(fit, pass, 0), false, 0.002),
            "no frame determines it by its own markers");
}

TEST(SlippedMarkers, AStepInTimeHasItsMarkerItsFrameAndItsSize) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 120});
  const FittedChain fit = known_geometry(limb, 0.001);
  EXPECT_TRUE(find_slipped_markers(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value()).empty());
  EXPECT_TRUE(find_loose_markers(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value()).empty());
  for (std::size_t f = 70; f < 120; ++f) {
    const Vector3d off = limb.pose[f].rotation[1] * Vector3d(0.0, 0.0, 0.012);
    for (int i = 0; i < 3; ++i) limb.samples.x[30 * f + 3 * 7 + static_cast<std::size_t>(i)] += off[i];
  }
  const auto slips = find_slipped_markers(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value());
  ASSERT_EQ(slips.size(), 1U);
  EXPECT_EQ(slips[0].marker, 7);
  EXPECT_EQ(slips[0].frame, 70);
  EXPECT_NEAR(slips[0].distance_m, 0.010, 0.004) << "its segment's pose follows it a little";
}

// A marker that swings on its segment all the time, as one of another body does, has slipped at no moment.
TEST(SlippedMarkers, AMarkerThatSwingsIsNotSaidToSlip) {
  for (const double period : {30.0, 55.0, 90.0, 150.0}) {
    RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 120});
    const FittedChain fit = known_geometry(limb, 0.001);
    for (std::size_t f = 0; f < 120; ++f) {
      const double swing = 0.012 * std::sin(2.0 * 3.14159265358979 * static_cast<double>(f) / period);
      const Vector3d off = limb.pose[f].rotation[1] * Vector3d(0.0, 0.0, swing);
      for (int i = 0; i < 3; ++i) limb.samples.x[30 * f + 3 * 7 + static_cast<std::size_t>(i)] += off[i];
    }
    const auto pass = pass_over(fit, limb.samples, 1, {}).value();
    EXPECT_TRUE(find_slipped_markers(fit, limb.samples, pass).empty()) << period;
    EXPECT_FALSE(find_loose_markers(fit, limb.samples, pass).empty()) << period;
  }
}

TEST(SwappedMarkers, TheExchangedPairIsNamed) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 40});
  const FittedChain fit = known_geometry(limb, 0.001);
  for (const std::size_t f : {10U, 11U, 12U})
    for (std::size_t i = 0; i < 3; ++i)
      std::swap(limb.samples.x[24 * f + 3 * 2 + i], limb.samples.x[24 * f + 3 * 5 + i]);
  const auto swaps = find_swapped_markers(fit, limb.samples, pass_over(fit, limb.samples, 1, {}).value());
  ASSERT_EQ(swaps.size(), 1U);
  EXPECT_EQ(swaps[0].marker_a, 2);
  EXPECT_EQ(swaps[0].marker_b, 5);
  EXPECT_EQ(swaps[0].first_frame, 10);
  EXPECT_EQ(swaps[0].frames, 3);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
