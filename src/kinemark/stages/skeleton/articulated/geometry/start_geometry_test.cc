// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/start_geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/skeleton/articulated/testing/distance_error.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing::HasSubstr;
using testing_limbs::distance_error;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

/// Largest error of the distances between each segment's markers and its upper joint, its origin.
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

// A hand of one marker: its joint is the centre of the sphere that the marker describes about the forearm.
TEST(StartGeometry, OneMarkerOnTheLastSegmentLiesOnASphere) {
  const RandomChain limb = make_random_chain({.frames = 100, .noise_sd_m = 0.0});
  ChainSamples four{.frames = 100, .markers = 4, .x = {}};
  for (int f = 0; f < 100; ++f)
    four.x.insert(four.x.end(), limb.samples.frame(f), limb.samples.frame(f) + 12);
  const ChainLayout layout{.parent = {0}, .segment_of_marker = {0, 0, 0, 1}};
  const auto start = start_geometry(four, layout, {SegmentKind::solid, SegmentKind::line}, 0.0);
  ASSERT_TRUE(start.has_value()) << start.error().message;
  EXPECT_NEAR(start->marker.col(3).norm(), limb.chain.marker.col(3).norm(), 1e-4);
  EXPECT_LT(distance_error(start->marker.leftCols(3), limb.chain.marker.leftCols(3)), 1e-6);
}

TEST(StartGeometry, APoorSegmentMustBeAnEnd) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 50});
  ChainSamples seven{.frames = 50, .markers = 7, .x = {}};
  for (int f = 0; f < 50; ++f) {
    const double* x = limb.samples.frame(f);
    seven.x.insert(seven.x.end(), x, x + 12);       // three of segment 0, one of segment 1
    seven.x.insert(seven.x.end(), x + 18, x + 27);  // three of segment 2
  }
  const ChainLayout layout{.parent = {0, 1}, .segment_of_marker = {0, 0, 0, 1, 2, 2, 2}};
  EXPECT_THAT(
      start_geometry(seven, layout, std::vector<SegmentKind>(3, SegmentKind::solid), 0.001).error().message,
      HasSubstr("too few markers between them"));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
