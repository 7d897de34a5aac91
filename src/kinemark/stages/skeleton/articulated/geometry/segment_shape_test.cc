// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using data::SegmentKind;
using testing::HasSubstr;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

/// Largest difference between the distances of two sets of points: no choice of axes changes it.
double distance_error(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      worst = std::max(worst, std::abs((a.col(i) - a.col(j)).norm() - (b.col(i) - b.col(j)).norm()));
  return worst;
}

/// The same for each segment's markers and its upper joint, its origin.
double geometry_error(const Chain& found, const Chain& truth) {
  double worst = 0.0;
  for (int s = 0; s < truth.segments(); ++s) {
    const auto markers = truth.layout.markers_of(s);
    Eigen::Matrix3Xd a = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(markers.size()) + 1), b = a;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      a.col(static_cast<Eigen::Index>(i)) = found.marker.col(markers[i]);
      b.col(static_cast<Eigen::Index>(i)) = truth.marker.col(markers[i]);
    }
    worst = std::max(worst, distance_error(a, b));
  }
  return worst;
}

/// No frame shows all of both segments: in even frames a marker of the first is hidden, in odd ones of the
/// second.
RandomChain never_both_whole(double noise_sd_m) {
  RandomChain limb = make_random_chain({.frames = 200, .noise_sd_m = noise_sd_m});
  for (int f = 0; f < 200; ++f) hide(limb.samples, f, f % 2 == 0 ? (f / 2) % 3 : 3 + (f / 2) % 3);
  return limb;
}

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

TEST(SegmentShape, AMarkerThatNothingTiesToTheOthersHasNoPlace) {
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

TEST(StartGeometry, IsExactOnExactData) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb = make_random_chain(
        {.segments = 3, .markers_per_segment = 4, .frames = 60, .kind = kind, .noise_sd_m = 0.0});
    const auto start = start_geometry(limb.samples, limb.chain.layout, limb.chain.kind, 0.0);
    ASSERT_TRUE(start.has_value()) << start.error().message;
    EXPECT_LT(geometry_error(*start, limb.chain), 1e-4);
    EXPECT_NEAR(start->joint.col(1).norm(), 0.150, 1e-4);
  }
}

// SCoRE wants frames that show both segments; without them each segment sees the other's markers on spheres.
TEST(StartGeometry, SpheresStandInWhereNoFrameShowsBothSegments) {
  const RandomChain exact = never_both_whole(0.0), noisy = never_both_whole(0.001);
  const auto start = start_geometry(exact.samples, exact.chain.layout, exact.chain.kind, 0.0);
  ASSERT_TRUE(start.has_value()) << start.error().message;
  EXPECT_LT(geometry_error(*start, exact.chain), 1e-4);
  const auto rough = start_geometry(noisy.samples, noisy.chain.layout, noisy.chain.kind, 0.001);
  ASSERT_TRUE(rough.has_value()) << rough.error().message;
  EXPECT_LT(geometry_error(*rough, noisy.chain), 0.010);
}

TEST(StartGeometry, SaysWhatIsMissing) {
  RandomChain limb = make_random_chain({.frames = 30, .kind = SegmentKind::line});
  // Each frame shows one segment alone.
  for (int f = 0; f < 30; ++f)
    for (int k = 0; k < 3; ++k) hide(limb.samples, f, f % 2 == 0 ? k : 3 + k);
  EXPECT_THAT(start_geometry(limb.samples, limb.chain.layout, limb.chain.kind, 0.001).error().message,
              HasSubstr("fewer than three frames show both segments"));
  const std::vector<SegmentKind> solid(2, SegmentKind::solid);
  EXPECT_FALSE(start_geometry(limb.samples, limb.chain.layout, solid, 0.001).has_value());
}

}  // namespace
}  // namespace kinemark::skeleton
