// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/plausibility/plausibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

/// Three segments, two joints, four markers each.
testing::TestChain sound_chain() {
  return testing::make_chain(
      {.frames = 120, .lengths_m = {0.15, 0.16, 0.12}, .per_segment = 4, .noise_sd_m = 0.002});
}

data::Skeleton sound_skeleton(const testing::TestChain& chain) {
  return find_joints(chain.markers, chain.layout).value();
}

/// Every marker of a segment anywhere within so much of its place, anew in every frame.
void shake(testing::TestChain& chain, std::size_t segment, double by_m) {
  Random random(5, 1);
  for (const int m : chain.layout.segments[segment].markers)
    for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
      for (double& c : chain.markers.x(f, m)) c += random.uniform(-by_m, by_m);
}

TEST(JudgeLayout, SaysNothingOfABody) {
  const auto chain = sound_chain();
  EXPECT_TRUE(judge_layout(chain.markers, chain.layout).empty());
}

TEST(JudgeLayout, NamesASegmentWithoutAShape) {
  auto chain = sound_chain();
  shake(chain, 1, 0.2);
  const auto found = judge_layout(chain.markers, chain.layout);
  ASSERT_EQ(found.size(), 1U) << "joints of the segment are not named beside it";
  EXPECT_TRUE(found[0].is_segment);
  EXPECT_EQ(found[0].name, chain.layout.segments[1].name);
  EXPECT_EQ(found[0].figure, BodyFigure::shape);
  EXPECT_GT(found[0].value_m, 0.05);
  EXPECT_EQ(found[0].markers.size(), 4U);
  EXPECT_NE(found[0].sentence().find("leave a rigid shape by"), std::string::npos);
  EXPECT_NE(found[0].sentence().find("20 mm or less"), std::string::npos);
}

TEST(JudgeLayout, NamesMarkersTooFarApart) {
  auto chain = sound_chain();
  for (double& c : chain.markers.x_in_world) c *= 20.0;
  const auto found = judge_layout(chain.markers, chain.layout, {.most_noise_m = 0.1});
  ASSERT_EQ(found.size(), 3U);
  for (const auto& f : found) {
    EXPECT_EQ(f.figure, BodyFigure::spread);
    EXPECT_NE(f.sentence().find(": two of its markers are "), std::string::npos) << f.sentence();
    EXPECT_NE(f.sentence().find("1500 mm or less is expected of a body"), std::string::npos) << f.sentence();
  }
}

TEST(JudgeLayout, NamesAJointWithoutACommonPoint) {
  auto chain = sound_chain();
  Random random(6, 1);
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
    Eigen::Vector3d apart;
    for (double& c : apart) c = random.uniform(-0.3, 0.3);
    for (const int m : chain.layout.segments[2].markers) chain.markers.x(f, m) += apart;
  }
  const auto found = judge_layout(chain.markers, chain.layout);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].is_segment);
  EXPECT_EQ(found[0].name, chain.layout.joints[1].name);
  EXPECT_EQ(found[0].figure, BodyFigure::gap);
  EXPECT_NEAR(found[0].value_m, 0.17, 0.05) << "0.3 / sqrt(3)";
  EXPECT_NE(found[0].sentence().find("Joint 'j1': its two segments place it 1"), std::string::npos)
      << found[0].sentence();
  EXPECT_NE(found[0].sentence().find(" mm apart (RMS per axis); 20 mm or less is expected of a body."),
            std::string::npos);
}

TEST(JudgeSkeleton, SaysNothingOfABody) {
  const auto chain = sound_chain();
  EXPECT_TRUE(judge_skeleton(chain.markers, sound_skeleton(chain)).empty());
}

TEST(JudgeSkeleton, NamesTheJointThatIsKnownWorse) {
  const auto chain = sound_chain();
  auto skeleton = sound_skeleton(chain);
  ASSERT_EQ(skeleton.lengths.size(), 1U);
  for (const double length : {0.002, 2.0, 90181928.0, std::numeric_limits<double>::infinity()}) {
    skeleton.lengths[0].length_m = length;
    skeleton.joints[1].covariance_in_parent.setIdentity();
    const auto found = judge_skeleton(chain.markers, skeleton);
    ASSERT_EQ(found.size(), 1U) << length;
    EXPECT_EQ(found[0].figure, BodyFigure::length);
    EXPECT_EQ(found[0].name, skeleton.joints[1].name);
    EXPECT_EQ(found[0].other, skeleton.joints[0].name);
    EXPECT_NE(found[0].sentence().find("of the same segment; 5 to 1500 mm are expected of a body"),
              std::string::npos);
  }
  skeleton.lengths[0].length_m = 1.49;
  EXPECT_TRUE(judge_skeleton(chain.markers, skeleton).empty());
}

TEST(JudgeSkeleton, NamesAJointFarFromItsMarkers) {
  const auto chain = sound_chain();
  auto skeleton = sound_skeleton(chain);
  skeleton.joints[0].centre_in_parent.x() += 3.0;
  const auto found = judge_skeleton(chain.markers, skeleton);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].figure, BodyFigure::reach);
  EXPECT_NEAR(found[0].value_m, 3.0, 0.3);
  EXPECT_NE(found[0].sentence().find("mm from the nearest marker of a segment; 1500 mm or less"),
            std::string::npos)
      << found[0].sentence();
}

TEST(JudgeSkeleton, NamesAJointThatLeavesItsMarkers) {
  const auto chain = sound_chain();
  auto skeleton = sound_skeleton(chain);
  Random random(7, 1);
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    skeleton.centre_in_world[3 * skeleton.index(f, 1)] += random.uniform(-0.5, 0.5);
  const auto found = judge_skeleton(chain.markers, skeleton);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].figure, BodyFigure::distance);
  EXPECT_EQ(found[0].name, skeleton.joints[1].name);
  EXPECT_GT(found[0].value_m, 0.02);
  EXPECT_NE(found[0].sentence().find(": its distance from a marker of its segments changes by "),
            std::string::npos)
      << found[0].sentence();
}

TEST(JudgeSkeleton, NamesAJointWhereTheNoiseAloneIsTooLarge) {
  const auto chain = sound_chain();
  auto skeleton = sound_skeleton(chain);
  skeleton.noise_sd_m = 0.03894;
  const auto found = judge_skeleton(chain.markers, skeleton);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].figure, BodyFigure::noise);
  EXPECT_NE(found[0].sentence().find(": with it the markers' noise is 38.9 mm per axis"), std::string::npos)
      << found[0].sentence();
}

TEST(LeaveOut, TakesASegmentWithItsJointsAndAJointAlone) {
  const auto chain = sound_chain();
  const Implausible segment{
      .is_segment = true, .name = chain.layout.segments[2].name, .other = {}, .markers = {}};
  const Implausible joint{.name = chain.layout.joints[0].name, .other = {}, .markers = {}};
  const auto one = leave_out(chain.layout, std::vector{segment});
  EXPECT_EQ(one.segments.size(), 2U);
  ASSERT_EQ(one.joints.size(), 1U);
  EXPECT_EQ(one.joints[0].name, chain.layout.joints[0].name);
  const auto other = leave_out(chain.layout, std::vector{joint});
  EXPECT_EQ(other.segments.size(), 3U);
  ASSERT_EQ(other.joints.size(), 1U);
  EXPECT_EQ(other.joints[0].parent, 1);
}

TEST(PlausibilityOptions, AreChecked) {
  EXPECT_TRUE(PlausibilityOptions{}.check());
  EXPECT_FALSE((PlausibilityOptions{.most_noise_m = std::nan("")}.check()));
  EXPECT_FALSE((PlausibilityOptions{.least_length_m = 2.0}.check()));
}

}  // namespace
}  // namespace kinemark::skeleton
