// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/joint_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::skeleton::articulated {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

data::SegmentLayout layout(int segments, const std::vector<std::pair<int, int>>& joints) {
  data::SegmentLayout out;
  for (int s = 0; s < segments; ++s)
    out.segments.push_back({.name = "s" + std::to_string(s), .markers = {2 * s, 2 * s + 1}});
  for (std::size_t j = 0; j < joints.size(); ++j)
    out.joints.push_back(
        {.name = "j" + std::to_string(j), .parent = joints[j].first, .child = joints[j].second});
  return out;
}

TEST(JointTree, KeepsTheOrderOfAChain) {
  const JointTree tree(layout(4, {{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_THAT(tree.segment_order, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(tree.joint_order, ElementsAre(0, 1, 2));
  EXPECT_THAT(tree.holder, ElementsAre(0, 1, 2));
  EXPECT_THAT(tree.origin, ElementsAre(0, 0, 1, 2));
}

TEST(JointTree, WalksOutwardsFromTheFirstJointWhateverItsName) {
  // The first joint is in the middle of the limb; the second one names its child first.
  const JointTree tree(layout(4, {{2, 1}, {3, 2}, {1, 0}}));
  EXPECT_THAT(tree.segment_order, ElementsAre(2, 1, 3, 0));
  EXPECT_THAT(tree.joint_order, ElementsAre(0, 1, 2));
  EXPECT_THAT(tree.holder, ElementsAre(2, 2, 1));
  EXPECT_THAT(tree.outer, ElementsAre(1, 3, 0));
  EXPECT_THAT(tree.origin, ElementsAre(2, 0, 0, 1));
}

TEST(JointTree, EveryJointOfATrunkMeetsTheOthers) {
  EXPECT_THAT(joint_pairs(layout(4, {{0, 1}, {0, 2}, {2, 3}})), ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(JointTree, RefusesWhatIsNoTree) {
  EXPECT_THAT(check_tree(layout(1, {})).error().message, HasSubstr("all markers are on segment 's0'"));
  EXPECT_THAT(check_tree(layout(0, {})).error().message, HasSubstr("no segment has markers"));
  EXPECT_THAT(check_tree(layout(2, {})).error().message, HasSubstr("no joint"));
  EXPECT_THAT(check_tree(layout(4, {{0, 1}, {2, 3}})).error().message,
              HasSubstr("from segment 's0' to segment 's2'"));
  EXPECT_TRUE(check_tree(layout(3, {{0, 1}, {2, 1}})).has_value());
}

TEST(JointTree, ArrangesMarkersAndTakesOnlyWhatWasMeasured) {
  const auto tree_layout = layout(3, {{2, 1}, {1, 0}});
  auto markers =
      data::Trajectories::all_missing({"a", "b", "c", "d", "e", "f"}, {.rate_hz = 60, .frames = 2});
  for (int m = 0; m < 6; ++m) {
    markers.x(1, m) = Eigen::Vector3d{1.0 * m, 2.0 * m, 3.0 * m};
    markers.state[markers.index(1, m)] = data::SampleState::measured;
  }
  markers.state[markers.index(1, 3)] = data::SampleState::interpolated;
  const auto input = arrange(markers, tree_layout, JointTree(tree_layout));
  EXPECT_THAT(input.marker, ElementsAre(4, 5, 2, 3, 0, 1));
  EXPECT_THAT(input.layout.segment_of_marker, ElementsAre(0, 0, 1, 1, 2, 2));
  EXPECT_THAT(input.layout.parent, ElementsAre(0, 1));
  EXPECT_FALSE(input.samples.seen(0, 0));
  EXPECT_TRUE(input.samples.seen(1, 0));
  EXPECT_FALSE(input.samples.seen(1, 3)) << "interpolated";
  EXPECT_EQ(input.samples.frame(1)[2], 12.0);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
