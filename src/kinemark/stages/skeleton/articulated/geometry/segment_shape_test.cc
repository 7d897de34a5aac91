// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/testing/distance_error.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing_limbs::distance_error;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::move_lab;
using testing_limbs::RandomChain;

TEST(SegmentShape, IsExactAboutItsMeanInPrincipalAxes) {
  const RandomChain limb =
      make_random_chain({.markers_per_segment = 5, .frames = 50, .noise_sd_m = 0.0, .missing = 0.2});
  const std::vector<int> markers{0, 1, 2, 3, 4};
  const auto shape = segment_shape(limb.samples, markers, SegmentKind::solid, 0.0);
  ASSERT_TRUE(shape.has_value()) << shape.error().message;
  EXPECT_LT(distance_error(*shape, limb.chain.marker.leftCols(5)), 1e-9);
  EXPECT_LT(shape->rowwise().sum().norm(), 1e-9);
  EXPECT_GT(shape->row(2).norm(), shape->row(0).norm());
  EXPECT_GT(shape->row(0).norm(), shape->row(1).norm());
}

// Noise adds 6 sigma^2 to every squared distance: a known noise is taken off.
TEST(SegmentShape, NoiseDoesNotStretchALine) {
  const RandomChain limb =
      make_random_chain({.frames = 2000, .kind = SegmentKind::line, .noise_sd_m = 0.005});
  const std::vector<int> markers{0, 1, 2};
  const auto span = [&](double sigma_m) {
    const auto shape = segment_shape(limb.samples, markers, SegmentKind::line, sigma_m).value();
    EXPECT_EQ(shape.topRows<2>().norm(), 0.0);
    return std::abs(shape(2, 2) - shape(2, 0));
  };
  EXPECT_NEAR(span(0.005), 0.075, 0.0006);
  EXPECT_NEAR(span(0.0) - span(0.005), 0.001, 0.0003);
}

TEST(SegmentShape, OppositeMarkersNeedNotBeSeenTogether) {
  RandomChain limb = make_random_chain({.markers_per_segment = 6, .frames = 60, .noise_sd_m = 0.0});
  for (int f = 0; f < 60; ++f) hide(limb.samples, f, f % 2 == 0 ? 0 : 5);
  const std::vector<int> markers{0, 1, 2, 3, 4, 5};
  const auto shape = segment_shape(limb.samples, markers, SegmentKind::solid, 0.0).value();
  EXPECT_LT(distance_error(shape, limb.chain.marker.leftCols(6)), 1e-8);
}

TEST(SegmentShape, AMarkerThatNothingTiesToTheOthersHasNoPosition) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 40, .noise_sd_m = 0.0});
  for (int f = 0; f < 40; ++f)
    for (const int k : f < 2 ? std::vector<int>{} : std::vector<int>{4}) hide(limb.samples, f, k);
  const std::vector<int> markers{0, 1, 2, 3, 4};
  const auto shape = segment_shape(limb.samples, markers, SegmentKind::solid, 0.0).value();
  EXPECT_TRUE(std::isnan(shape(0, 4))) << "two frames are too few";
  EXPECT_LT(distance_error(shape.leftCols(4), limb.chain.marker.leftCols(4)), 1e-9);
}

TEST(RigidPose, NeedsThreeMarkersOrTwoOfALine) {
  RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  const std::vector<int> markers{0, 1, 2};
  const Eigen::Matrix3Xd shape = limb.chain.marker.leftCols(3);
  Matrix3d R;
  Vector3d o;
  double spread = 0.0;
  ASSERT_TRUE(rigid_pose(limb.samples, 0, markers, shape, SegmentKind::solid, R, o, spread));
  EXPECT_LT((R - limb.pose[0].rotation[0]).norm(), 1e-9);
  EXPECT_LT((o - limb.pose[0].joint0).norm(), 1e-9);
  EXPECT_GT(spread, 1e-4);
  hide(limb.samples, 0, 1);
  EXPECT_FALSE(rigid_pose(limb.samples, 0, markers, shape, SegmentKind::solid, R, o, spread));
  EXPECT_TRUE(rigid_pose(limb.samples, 0, markers, shape, SegmentKind::line, R, o, spread));
  hide(limb.samples, 0, 2);
  EXPECT_FALSE(rigid_pose(limb.samples, 0, markers, shape, SegmentKind::line, R, o, spread));
}

TEST(SegmentShape, DoesNotChangeWithTheLab) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 80, .missing = 0.2});
  const std::vector<int> markers{0, 1, 2, 3, 4};
  const auto here = segment_shape(limb.samples, markers, SegmentKind::solid, 0.001).value();
  move_lab(limb, math::exp_so3({-0.8, 0.5, 0.9}), {3.0, -1.0, 0.2});
  const auto there = segment_shape(limb.samples, markers, SegmentKind::solid, 0.001).value();
  EXPECT_LT(distance_error(here, there), 1e-9);
}

TEST(SegmentShape, APlaneHasNoThirdCoordinate) {
  const RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 60});
  const std::vector<int> markers{0, 1, 2, 3};
  const auto shape = segment_shape(limb.samples, markers, SegmentKind::plane, 0.001).value();
  EXPECT_EQ(shape.row(1).norm(), 0.0);
  EXPECT_GT(shape.row(0).norm(), 0.01);
}

TEST(SegmentShape, WantsThreeMarkersThatAreSeenTogether) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 30});
  for (int f = 0; f < 30; ++f)
    for (const int k : {f % 4, (f + 1) % 4}) hide(limb.samples, f, k);
  const std::vector<int> markers{0, 1, 2, 3};
  EXPECT_FALSE(segment_shape(limb.samples, markers, SegmentKind::solid, 0.001).has_value());
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
