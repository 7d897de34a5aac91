// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/slip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::Rotations;

testing::ChainSetup setup() {
  return {.frames = 600,
          .per_segment = 5,
          .stagger_m = 0.03,
          .rotations = Rotations::cone,
          .range_rad = 1.2,
          .noise_sd_m = 0.001};
}

/// Move markers of the second segment along the bone from a frame on.
void slide(testing::TestChain& chain, std::int64_t from, const std::vector<int>& markers, double shift_m) {
  for (std::int64_t f = from; f < chain.markers.frames(); ++f)
    for (const int m : markers)
      chain.markers.x(f, m) += shift_m * chain.world_from_segment[1][static_cast<std::size_t>(f)].col(2);
}

TEST(Slip, NothingSlipsWhereNothingDoes) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    auto s = setup();
    s.seed = seed;
    s.missing = 0.1;
    const auto chain = testing::make_chain(s);
    const auto slips = find_slips(chain.markers, chain.layout);
    ASSERT_TRUE(slips);
    EXPECT_TRUE(slips->empty()) << sentence_of(slips->front(), chain.markers.time);
  }
}

TEST(Slip, OneMarkerIsFoundWithItsFrame) {
  auto chain = testing::make_chain(setup());
  slide(chain, 350, {6}, 0.012);
  const auto slips = find_slips(chain.markers, chain.layout);
  ASSERT_TRUE(slips);
  ASSERT_FALSE(slips->empty());
  EXPECT_EQ(slips->front().kind, data::FindingKind::marker_slip);
  EXPECT_EQ(slips->front().subject, "s1m1");
  EXPECT_EQ(slips->front().partner, chain.layout.segments[1].name);
  EXPECT_TRUE(slips->front().validate());
  EXPECT_NEAR(static_cast<double>(slips->front().first_frame), 350.0, 5.0);
  EXPECT_NEAR(slips->front().size, 0.012, 0.006) << "the pose gives way to it by its share";
  EXPECT_NE(sentence_of(slips->front(), chain.markers.time).find("'s1m1'"), std::string::npos);
  EXPECT_NE(sentence_of(slips->front(), chain.markers.time).find("at about 5.8"), std::string::npos)
      << sentence_of(slips->front(), chain.markers.time);
}

// So short that the seven frames after the change are fewer than the blocks of longer recordings.
TEST(Slip, AFewFramesAtTheEndHaveAScatterOfTheirOwn) {
  auto s = setup();
  s.frames = 70;
  auto slipped = testing::make_chain(s);
  auto shaken = slipped;
  slide(slipped, 63, {6}, 0.012);
  const auto slips = find_slips(slipped.markers, slipped.layout);
  ASSERT_TRUE(slips);
  ASSERT_FALSE(slips->empty());
  EXPECT_EQ(slips->front().subject, slipped.markers.names[6]);
  for (const data::Finding& slip : *slips) EXPECT_TRUE(std::isfinite(slip.size_sd)) << slip.subject;
  // To and fro by 40 mm: a mean of 6 mm with an SD of 15.
  for (std::int64_t f = 63; f < 70; ++f) {
    slide(shaken, f, {6}, f == 63 ? 0.040 : f % 2 == 0 ? -0.080 : 0.080);
  }
  const auto none = find_slips(shaken.markers, shaken.layout);
  ASSERT_TRUE(none);
  for (const data::Finding& slip : *none) EXPECT_EQ(slip.kind, data::FindingKind::joint_slip) << slip.subject;
}

// Half a period of a slow movement over the recording, with which the skin goes to and not fro.
TEST(Slip, SkinThatGoesWithASlowMovementDoesNotSlip) {
  auto chain = testing::make_chain(setup());
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
    const double phase = M_PI * static_cast<double>(f) / static_cast<double>(chain.markers.frames());
    chain.markers.x(f, 6) +=
        -0.012 * std::cos(phase) * chain.world_from_segment[1][static_cast<std::size_t>(f)].col(2);
  }
  const auto slips = find_slips(chain.markers, chain.layout);
  ASSERT_TRUE(slips);
  for (const data::Finding& slip : *slips)
    EXPECT_NE(slip.kind, data::FindingKind::marker_slip) << slip.subject;
}

TEST(Slip, AWholeSleeveIsSeenByItsJoint) {
  auto chain = testing::make_chain(setup());
  slide(chain, 300, chain.layout.segments[1].markers, 0.010);
  const auto slips = find_slips(chain.markers, chain.layout);
  ASSERT_TRUE(slips);
  ASSERT_EQ(slips->size(), 1U);
  EXPECT_EQ(slips->front().kind, data::FindingKind::joint_slip);
  EXPECT_EQ(slips->front().subject, chain.layout.joints[0].name);
  EXPECT_EQ(slips->front().partner, chain.layout.segments[1].name);
  EXPECT_THAT(sentence_of(slips->front(), chain.markers.time), ::testing::EndsWith("slip together?"));
  EXPECT_NEAR(slips->front().size, 0.010, 0.003);
}

TEST(Slip, OfAJointThatIsNotKnownSoWellIsNone) {
  data::Skeleton skeleton;
  skeleton.segments = {{.name = "pelvis"}, {.name = "thigh"}};
  skeleton.joints = {{.name = "hip", .parent_segment = 0, .child_segment = 1}};
  auto& hip = skeleton.joints[0];
  hip.covariance_in_parent = 0.016 * 0.016 * Eigen::Matrix3d::Identity();
  hip.covariance_in_child.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto slip = [](double size_m, const char* segment) {
    return data::Finding{.kind = data::FindingKind::joint_slip,
                         .subject = "hip",
                         .partner = segment,
                         .size = size_m,
                         .size_sd = 0.001};
  };
  EXPECT_TRUE(is_within_repeatability(slip(0.06, "pelvis"), skeleton)) << "by the accuracy";
  EXPECT_TRUE(is_within_repeatability(slip(0.06, "thigh"), skeleton)) << "nothing is known of it";
  hip.repeatability_in_parent = Eigen::Vector3d(1e-6, 4e-6, 1e-4).asDiagonal();
  EXPECT_TRUE(is_within_repeatability(slip(0.059, "pelvis"), skeleton)) << "3 times 2 times 10 mm";
  EXPECT_FALSE(is_within_repeatability(slip(0.062, "pelvis"), skeleton));
  hip.kind = data::JointKind::hinge;
  EXPECT_FALSE(is_within_repeatability(slip(0.014, "pelvis"), skeleton)) << "across the axis";
  auto of_marker = slip(0.001, "pelvis");
  of_marker.kind = data::FindingKind::marker_slip;
  EXPECT_FALSE(is_within_repeatability(of_marker, skeleton));
}

TEST(Slip, RefusesWhatDoesNotFit) {
  auto chain = testing::make_chain({.frames = 100});
  EXPECT_FALSE(find_slips(chain.markers, chain.layout, {.sure_sd = 0.0}));
  EXPECT_FALSE(find_slips(chain.markers, chain.layout, {.least_m = -1.0}));
  chain.layout.segments[0].markers.push_back(99);
  EXPECT_FALSE(find_slips(chain.markers, chain.layout));
}

}  // namespace
}  // namespace kinemark::skeleton
