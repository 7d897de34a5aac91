// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::internal {
namespace {

using testing::Rotations;

/// Poses of a chain's two segments, and the place that they share.
struct Limb {
  explicit Limb(const testing::ChainSetup& setup)
      : chain(testing::make_chain(setup)), samples{chain.markers, {}}, store(samples) {}
  [[nodiscard]] std::optional<Place> place() { return find_place(side(0), side(1)); }
  [[nodiscard]] const SegmentPoses& side(std::size_t s) { return store.of(chain.layout.segments[s].markers); }
  testing::TestChain chain;
  Samples samples;
  PoseStore store;
};

TEST(Place, ABallIsWhereItIs) {
  Limb limb({.per_segment = 4, .stagger_m = 0.03, .rotations = Rotations::cone});
  const auto place = limb.place();
  ASSERT_TRUE(place);
  EXPECT_LT(place->gap_m, 1e-3);
  EXPECT_FALSE(place->hinge);
  EXPECT_GT(place->turn_rad[0], 0.1);
  for (Eigen::Index f = 0; f < 300; f += 50)
    EXPECT_LT((place->path.col(f) - limb.chain.centres[0].col(f)).norm(), 1e-3);
}

TEST(Place, AHingesPlaceCountsAcrossItsAxisAlone) {
  Limb limb({.per_segment = 4, .stagger_m = 0.03, .rotations = Rotations::hinge});
  const auto place = limb.place();
  ASSERT_TRUE(place && place->hinge);
  Place along = *place, across = *place;
  for (Eigen::Index f = 0; f < along.path.cols(); ++f) {
    along.path.col(f) += 0.05 * place->axis.col(f);
    across.path.col(f) += 0.05 * place->axis.col(f).unitOrthogonal();
  }
  EXPECT_NEAR(distance(*place, along), 0.0, 1e-9);
  EXPECT_NEAR(distance(*place, across), 0.05, 1e-9);
}

TEST(Place, WhatWasNeverSeenTogetherHasNone) {
  Limb limb({.per_segment = 4, .stagger_m = 0.03, .rotations = Rotations::cone});
  const auto first = within(limb.side(0), 0, 150), last = within(limb.side(1), 150, 300);
  EXPECT_EQ(first.known_frames, 150);
  EXPECT_FALSE(find_place(first, last));
  const auto early = find_place(first, within(limb.side(1), 0, 150)),
             late = find_place(within(limb.side(0), 150, 300), last);
  ASSERT_TRUE(early && late);
  EXPECT_TRUE(std::isinf(distance(*early, *late))) << "no frame has both";
  EXPECT_LT(distance(*limb.place(), *early), 1e-3);
}

TEST(Place, ALineHasNoPose) {
  Eigen::Matrix3Xd x(3, 4);
  x << 0.0, 0.1, 0.2, 0.3, 0.0, 0.02, 0.0, 0.02, 0.0, 0.0, 0.0, 0.0;
  EXPECT_TRUE(is_wide(x, 0.001)) << "9 mm about the line, 8 are needed";
  EXPECT_FALSE(is_wide(x, 0.0015));
  EXPECT_FALSE(is_wide(x.leftCols(2), 1e-6)) << "two markers are a line, whatever their noise";
  x.row(1).setZero();
  EXPECT_FALSE(is_wide(x, 1e-6));
}

}  // namespace
}  // namespace kinemark::skeleton::internal
