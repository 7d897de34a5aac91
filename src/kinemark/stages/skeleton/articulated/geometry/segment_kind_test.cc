// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/segment_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/true_poses.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing::Each;
using testing::ElementsAre;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::move_lab;
using testing_limbs::RandomChain;
using testing_limbs::redraw;
using testing_limbs::true_poses;

TEST(ChooseKinds, FindsLinesPlanesAndSolids) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb = make_random_chain({.frames = 120, .kind = kind});
    const auto chosen = choose_kinds(limb.samples, limb.chain.layout, 0.0);
    ASSERT_TRUE(chosen.has_value());
    EXPECT_THAT(*chosen, Each(kind)) << data::to_string(kind);
  }
}

// 60 % missing leaves few frames or none with both segments whole.
TEST(ChooseKinds, SolidsStaySolidWhereNoFrameShowsBothSegments) {
  RandomChain limb = make_random_chain({.frames = 100, .noise_sd_m = 0.002});
  for (int f = 0; f < 100; ++f) hide(limb.samples, f, f % 2 == 0 ? (f / 2) % 3 : 3 + (f / 2) % 3);
  const auto chosen = choose_kinds(limb.samples, limb.chain.layout, 0.0);
  ASSERT_TRUE(chosen.has_value()) << chosen.error().message;
  EXPECT_THAT(*chosen, Each(SegmentKind::solid));
  const auto fit = fit_chain(limb.samples, limb.chain.layout);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_NEAR(fit->noise_sd_m, 0.002, 0.0003);
}

TEST(ChooseKinds, TakesTheLineWhereNoiseHidesTheStagger) {
  const RandomChain limb = make_random_chain({.frames = 150, .stagger_m = 0.002, .noise_sd_m = 0.003});
  EXPECT_THAT(choose_kinds(limb.samples, limb.chain.layout, 0.003).value(),
              ElementsAre(SegmentKind::line, SegmentKind::line));
}

TEST(AcrossLine, IsANormalDeviateForALine) {
  const RandomChain line = make_random_chain({.frames = 300, .kind = SegmentKind::line});
  const RandomChain solid = make_random_chain({.frames = 300, .stagger_m = 0.005});
  EXPECT_LT(std::abs(across_line(line.samples, std::vector<int>{0, 1, 2}, 0.001)), 3.0);
  EXPECT_GT(across_line(solid.samples, std::vector<int>{0, 1, 2}, 0.001), 50.0);
  EXPECT_EQ(across_line(line.samples, std::vector<int>{0, 1}, 0.001), 0.0);
}

// Two markers between two joints are a line; what is beside them keeps its kind.
TEST(ChooseKinds, TwoMarkersAreALineAndTheirNeighboursAreNot) {
  RandomChain limb = make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 120});
  for (const int k : {4, 5}) limb.chain.marker.col(k).head<2>().setZero();
  redraw(limb, 0.001, 4);
  ChainSamples ten{.frames = 120, .markers = 10, .x = {}};
  for (int f = 0; f < 120; ++f) {
    const double* x = limb.samples.frame(f);
    ten.x.insert(ten.x.end(), x, x + 18);
    ten.x.insert(ten.x.end(), x + 24, x + 36);
  }
  const ChainLayout layout{.parent = {0, 1}, .segment_of_marker = {0, 0, 0, 0, 1, 1, 2, 2, 2, 2}};
  const auto chosen = choose_kinds(ten, layout, 0.0);
  ASSERT_TRUE(chosen.has_value()) << chosen.error().message;
  EXPECT_THAT(*chosen, ElementsAre(SegmentKind::solid, SegmentKind::line, SegmentKind::solid));
  const auto fit = fit_chain(ten, layout);
  ASSERT_TRUE(fit.has_value()) << fit.error().message;
  EXPECT_NEAR(fit->noise_sd_m, 0.001, 0.0001);
}

TEST(ChooseKinds, StopsWhenAsked) {
  const RandomChain limb = make_random_chain({.frames = 120});
  const auto chosen = choose_kinds(limb.samples, limb.chain.layout, 0.001, [] { return true; });
  ASSERT_FALSE(chosen.has_value());
  EXPECT_EQ(chosen.error().code, Code::cancelled);
}

TEST(ChooseKinds, MarkersThatAreNeverSeenHaveNoKind) {
  RandomChain limb = make_random_chain({.frames = 30});
  for (int f = 0; f < 30; ++f)
    for (int k = 0; k < 6; ++k) hide(limb.samples, f, k);
  EXPECT_FALSE(choose_kinds(limb.samples, limb.chain.layout, 0.001).has_value());
}

// Collinear markers: a plane or solid explains them as well and pays for its parameters.
TEST(LogEvidence, PrefersTheKindThatMadeTheData) {
  const RandomChain line = make_random_chain({.frames = 60, .kind = SegmentKind::line});
  const RandomChain plane = make_random_chain({.frames = 60, .kind = SegmentKind::plane});
  const auto evidence = [](const RandomChain& limb, SegmentKind kind) {
    Chain chain(limb.chain.layout, {kind, kind});
    chain.marker = limb.chain.marker;
    if (kind == SegmentKind::line) chain.marker.row(0).setZero();
    PosedFrames frames = true_poses(limb);
    (void)GeometryFit(chain, limb.samples, frames).run(10);
    return log_evidence(chain, limb.samples, frames, 0.001);
  };
  EXPECT_GT(evidence(line, SegmentKind::line), evidence(line, SegmentKind::plane));
  EXPECT_GT(evidence(plane, SegmentKind::plane), evidence(plane, SegmentKind::line) + 100.0);
}

TEST(LogEvidence, DoesNotChangeWithTheLab) {
  RandomChain limb = make_random_chain({.frames = 20});
  PosedFrames frames = true_poses(limb);
  const double before = log_evidence(limb.chain, limb.samples, frames, 0.001);
  move_lab(limb, math::exp_so3({0.3, -0.9, 1.4}), {1.0, -2.0, 0.5});
  frames = true_poses(limb);
  EXPECT_NEAR(log_evidence(limb.chain, limb.samples, frames, 0.001), before, 1e-5);
}

TEST(AcrossPlane, IsANormalDeviateForAPlane) {
  const std::vector<int> four{0, 1, 2, 3}, three{0, 1, 2};
  const RandomChain plane =
      make_random_chain({.markers_per_segment = 4, .frames = 300, .kind = SegmentKind::plane});
  const RandomChain solid = make_random_chain({.markers_per_segment = 4, .frames = 300});
  EXPECT_LT(std::abs(across_plane(plane.samples, four, 0.001)), 3.0);
  EXPECT_GT(across_plane(solid.samples, four, 0.001), 60.0);
  EXPECT_EQ(across_plane(solid.samples, three, 0.001), 0.0) << "three lie in a plane";
}

TEST(AcrossLine, WantsThreeFramesThatShowAllMarkers) {
  RandomChain limb = make_random_chain({.frames = 4});
  const std::vector<int> markers{0, 1, 2};
  EXPECT_GT(across_line(limb.samples, markers, 0.001), 10.0);
  for (const int f : {0, 2}) hide(limb.samples, f, 1);
  EXPECT_EQ(across_line(limb.samples, markers, 0.001), 0.0);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
