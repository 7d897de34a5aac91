// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/agreed.h"

#include <gtest/gtest.h>

#include <string>

namespace kinemark::skeleton::internal {
namespace {

const std::vector<int> kA{0, 1, 2}, kB{3, 4, 5}, kC{6, 7, 8}, kD{9, 10, 11};

/// A ball at x all the time.
Place ball(const std::vector<int>& a, const std::vector<int>& b, double x, double gap_m = 0.002) {
  Place place;
  place.a = a;
  place.b = b;
  place.gap_m = gap_m;
  place.turn_rad = {0.3, 0.2, 0.1};
  place.path = Eigen::Vector3d(x, 0.0, 0.0).replicate(1, 10);
  return place;
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (int m = 1; m <= 12; ++m) out.push_back("M" + std::to_string(m));
  return out;
}

/// What becomes of rivals: joints in the order of their agreements.
struct Outcome {
  explicit Outcome(std::vector<Rival> of) : rivals(std::move(of)), agreements(find_agreements(rivals)) {
    for (const auto& agreement : agreements)
      found.joints.push_back(judge_agreement(agreement, rivals, {}, names()));
    lay_out_agreed(agreements, rivals, found);
  }
  [[nodiscard]] bool says(const std::string& words) const {
    for (const auto& joint : found.joints)
      if (joint.reason.find(words) != std::string::npos) return true;
    return false;
  }
  [[nodiscard]] int known() const {
    int n = 0;
    for (const auto& joint : found.joints) n += joint.known;
    return n;
  }
  std::vector<Rival> rivals;
  std::vector<Agreement> agreements;
  Segmentation found;
};

TEST(Agreed, WhatAllRivalsHaveIsKnownAndNothingIsHeldAgainstIt) {
  const Outcome out({{{}, 0.7, {ball(kA, kB, 0.0)}}, {{}, 0.3, {ball(kA, kB, 0.004)}}});
  ASSERT_EQ(out.found.joints.size(), 1U);
  const auto& joint = out.found.joints[0];
  EXPECT_TRUE(joint.known);
  EXPECT_FALSE(joint.hinge);
  EXPECT_DOUBLE_EQ(joint.gap_m, 0.002);
  EXPECT_DOUBLE_EQ(joint.turn_rad, 0.3);
  EXPECT_NEAR(joint.weight, 1.0, 1e-12);
  EXPECT_GT(joint.spread_m, 0.001);
  EXPECT_TRUE(joint.rivals.empty()) << "the same clusters are no rival";
  EXPECT_FALSE(out.says("of the segmentations that the data allow have it"));
  EXPECT_FALSE(out.says("segmentations that the data allow place it"));
  EXPECT_FALSE(out.says("its two segments place it"));
  EXPECT_FALSE(out.says("of the segmentations that the data allow have another joint near it instead"));
  EXPECT_FALSE(out.says("its segments share markers with those of other joints"));
  EXPECT_FALSE(out.says("other joints connect its two segments already"));
}

TEST(Agreed, TooFewRivalsHaveIt) {
  const Outcome out({{{}, 0.4, {ball(kA, kB, 0.0)}}, {{}, 0.6, {}}});
  EXPECT_TRUE(out.says("40 % of the segmentations that the data allow have it, 50 at least are needed"));
  EXPECT_EQ(out.known(), 0);
  EXPECT_TRUE(out.found.layout.joints.empty() && out.found.layout.segments.empty());
  EXPECT_EQ(out.found.joints[0].name, "M1-M4") << "by its first markers";
  EXPECT_TRUE(out.found.joints[0].parent_name.empty());
}

TEST(Agreed, RivalsThatPlaceItApart) {
  const Outcome out({{{}, 0.5, {ball(kA, kB, 0.0)}}, {{}, 0.5, {ball(kA, kB, 0.025)}}});
  EXPECT_TRUE(out.says("segmentations that the data allow place it 17.7 mm apart (RMS; 10 at most)"));
  EXPECT_EQ(out.known(), 0);
}

TEST(Agreed, SegmentsThatPlaceItApart) {
  const Outcome out({{{}, 1.0, {ball(kA, kB, 0.0, 0.015)}}});
  EXPECT_TRUE(out.says("its two segments place it 15.0 mm apart (RMS; 12 at most)"));
  EXPECT_EQ(out.known(), 0);
}

TEST(Agreed, AnotherJointNearItInstead) {
  const Outcome out({{{}, 0.6, {ball(kA, kB, 0.0)}}, {{}, 0.4, {ball(kA, kC, 0.1)}}});
  EXPECT_TRUE(out.says("40 % of the segmentations that the data allow have another joint near it instead"));
  EXPECT_EQ(out.known(), 0);
  ASSERT_EQ(out.found.joints[0].rivals.size(), 1U);
  const auto& rival = out.found.joints[0].rivals[0];
  EXPECT_EQ(rival.child, kC);
  EXPECT_NEAR(rival.distance_m, 0.1, 1e-12);
  EXPECT_NEAR(rival.weight, 0.4, 1e-12);
  const std::string sentence = out.found.joints[0].sentence(names());
  EXPECT_NE(sentence.find("a rival: [M1, M2, M3] and [M7, M8, M9], 100 mm away."), std::string::npos)
      << sentence;
}

TEST(Agreed, OtherClustersOfTheSameJointAreListedOnce) {
  const Outcome out({{{}, 0.5, {ball(kA, kB, 0.0)}},
                     {{}, 0.2, {ball(kA, kC, 0.003)}},
                     {{}, 0.2, {ball(kA, kC, 0.003)}},
                     {{}, 0.1, {ball(kA, kD, 0.004)}}});
  ASSERT_EQ(out.found.joints.size(), 1U);
  const auto& rivals = out.found.joints[0].rivals;
  ASSERT_EQ(rivals.size(), 2U);
  EXPECT_EQ(rivals[0].child, kC) << "the one of more weight first";
  EXPECT_NEAR(rivals[0].weight, 0.4, 1e-12);
  EXPECT_NEAR(rivals[1].distance_m, 0.004, 1e-12);
}

TEST(Agreed, NoMarkerLiesOnTwoSegments) {
  const std::vector<int> overlaps{5, 6, 7};
  const Outcome out({{{}, 0.5, {ball(kA, kB, 0.0)}}, {{}, 0.5, {ball(overlaps, kD, 1.0)}}});
  ASSERT_EQ(out.found.joints.size(), 2U);
  EXPECT_EQ(out.known(), 1);
  EXPECT_TRUE(out.says("its segments share markers with those of other joints"));
  EXPECT_EQ(out.found.layout.segments.size(), 2U);
  const Outcome apart({{{}, 0.5, {ball(kA, kB, 0.0)}}, {{}, 0.5, {ball(kC, kD, 1.0)}}});
  EXPECT_EQ(apart.known(), 2);
  EXPECT_EQ(apart.found.layout.segments.size(), 4U);
  EXPECT_FALSE(apart.says("its segments share markers with those of other joints"));
}

TEST(Agreed, ClustersOfTheRivalThatHasMostJointsAreTaken) {
  // The first rival has both joints, the second only one, with other clusters and more weight.
  const std::vector<int> wider{3, 4, 5, 6};
  const Outcome out({{{}, 0.45, {ball(kA, kB, 0.0), ball(kB, kD, 1.0)}}, {{}, 0.55, {ball(kA, wider, 0.0)}}});
  ASSERT_EQ(out.found.joints.size(), 2U);
  EXPECT_EQ(out.known(), 1) << "the other joint has 45 % of the weight";
  const Outcome more(
      {{{}, 0.51, {ball(kA, kB, 0.0), ball(kB, kD, 1.0)}}, {{}, 0.49, {ball(kA, wider, 0.0)}}});
  ASSERT_EQ(more.known(), 2);
  EXPECT_EQ(more.found.layout.segments.size(), 3U);
  EXPECT_EQ(more.found.layout.segments[1].markers, kB);
}

TEST(Agreed, JointsMakeNoCircle) {
  const Outcome out(
      {{{}, 0.5, {ball(kA, kB, 0.0), ball(kB, kC, 1.0)}}, {{}, 0.5, {ball(kA, kB, 0.0), ball(kA, kC, 2.0)}}});
  ASSERT_EQ(out.found.joints.size(), 3U);
  EXPECT_EQ(out.known(), 2);
  EXPECT_TRUE(out.says("other joints connect its two segments already"));
  EXPECT_TRUE(out.found.layout.validate(12));
}

TEST(Agreed, SegmentsAreNumberedByTheirFirstMarkerAndJointsLeadAwayFromIt) {
  const Outcome out({{{}, 1.0, {ball(kD, kB, 0.0), ball(kB, kA, 1.0)}}});
  ASSERT_EQ(out.found.layout.segments.size(), 3U);
  EXPECT_EQ(out.found.layout.segments[0].markers, kA);
  EXPECT_EQ(out.found.layout.segments[2].name, "segment3");
  ASSERT_EQ(out.found.layout.joints.size(), 2U);
  ASSERT_EQ(out.found.spread_m.size(), 2U);
  for (std::size_t j = 0; j < 2; ++j) {
    const auto& joint = out.found.layout.joints[j];
    EXPECT_LT(joint.parent, joint.child);
    EXPECT_EQ(joint.name, out.found.joints[j].name);
    EXPECT_EQ(out.found.joints[j].parent,
              out.found.layout.segments[static_cast<std::size_t>(joint.parent)].markers);
  }
  EXPECT_EQ(out.found.joints[0].name, "segment2-segment3");
  EXPECT_EQ(out.found.joints[1].child_name, "segment2");
}

TEST(Agreed, ManyRivalsAreCutToTheHeaviest) {
  std::vector<Rival> rivals{{{}, 0.5, {ball(kA, kB, 0.0)}}};
  for (int k = 0; k < 10; ++k) rivals.push_back({{}, 0.01 * (k + 1), {ball({0, 1}, {3 + k, 20 + k}, 0.002)}});
  const auto agreements = find_agreements(rivals);
  ASSERT_EQ(agreements.size(), 1U);
  std::vector<std::string> many;
  for (int m = 0; m < 40; ++m) many.push_back("M" + std::to_string(m + 1));
  const auto joint = judge_agreement(agreements[0], rivals, {}, many);
  ASSERT_EQ(joint.rivals.size(), 8U);
  EXPECT_NEAR(joint.rivals[0].weight, 0.1, 1e-12);
  EXPECT_NEAR(joint.rivals[7].weight, 0.03, 1e-12);
  const std::string sentence = joint.sentence(many);
  EXPECT_NE(sentence.find("; rivals: [M1, M2] and [M13, M30]"), std::string::npos) << sentence;
  EXPECT_EQ(std::ranges::count(sentence, ';'), 3) << "three of them are named: " << sentence;
}

}  // namespace
}  // namespace kinemark::skeleton::internal
