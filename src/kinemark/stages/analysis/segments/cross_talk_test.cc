// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/cross_talk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
constexpr double kDegree = std::numbers::pi / 180.0;

// A hinge that flexes by 0 to 60 deg, seen in frames whose knee axis is turned about the long axis by `turn`;
// `own` deg of varus that have nothing to do with flexion.
SegmentSeries knee(double turn_deg, double own_deg) {
  SegmentSeries out{.name = "LKneeAngles", .labels = {"flexion", "varus", "rotation"}};
  const Eigen::Matrix3d seen =
      Eigen::AngleAxisd(turn_deg * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int f = 0; f < 200; ++f) {
    const double phase = 2.0 * std::numbers::pi * f / 50.0;
    const Eigen::Matrix3d flexed =
        Eigen::AngleAxisd(kDegree * (30.0 - 30.0 * std::cos(phase)), Eigen::Vector3d::UnitY())
            .toRotationMatrix();
    const auto a = sequence_angles(seen.transpose() * flexed * seen, {1, 0, 2});
    out.value.insert(out.value.end(), {a[0], a[1] + own_deg * kDegree * std::sin(phase), a[2]});
  }
  out.value[3] = std::nan("");
  return out;
}

TEST(CrossTalk, IsSaidOfAHingeSeenAboutAWrongAxis) {
  const auto found = find_cross_talk(knee(12.0, 0.5));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->frames, 199);
  EXPECT_NEAR(found->flexion_rad / kDegree, 59.0, 1.5);
  EXPECT_TRUE(found->suspicious());
  EXPECT_THAT(found->sentence("LKneeAngles"), HasSubstr("LKneeAngles: varus follows flexion (r^2 = 0.9"));
  EXPECT_THAT(found->sentence("LKneeAngles"), HasSubstr("probably turned"));
  EXPECT_THAT(found->sentence("LKneeAngles"), Not(HasSubstr("varus does not follow flexion (")));
}

TEST(CrossTalk, IsNotSaidOfARightAxisNorOfALittleNorOfVarusOfItsOwn) {
  for (const auto& [turn, own] : {std::pair{0.0, 0.5}, {3.0, 0.5}, {5.0, 12.0}}) {
    const auto found = find_cross_talk(knee(turn, own));
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->suspicious()) << turn;
    EXPECT_EQ(found->follows(), turn == 3.0);
    EXPECT_THAT(found->sentence("knee"),
                HasSubstr(found->follows() ? "varus follows flexion, by less than 5 deg (r^2 = 0."
                                           : "varus does not follow flexion (r^2 = 0."));
    EXPECT_THAT(found->sentence("knee"), Not(HasSubstr("turned")));
  }
}

TEST(CrossTalk, IsNotSoughtInAKneeThatHardlyFlexes) {
  auto still = knee(12.0, 0.0);
  for (std::size_t i = 0; i < still.value.size(); i += 3) still.value[i] *= 0.2;
  EXPECT_FALSE(find_cross_talk(still));
  still.value.resize(9);
  EXPECT_FALSE(find_cross_talk(still));
}

}  // namespace
}  // namespace kinemark::analysis
