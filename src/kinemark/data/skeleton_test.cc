// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

Skeleton elbow() {
  Skeleton s;
  s.markers = {"a", "b", "c"};
  s.segments = {{"upper", SegmentKind::line, {0, 1}, Eigen::Matrix3Xd::Zero(3, 2)},
                {"lower", SegmentKind::solid, {2}, Eigen::Matrix3Xd::Zero(3, 1)}};
  SkeletonJoint joint;
  joint.name = "elbow";
  joint.child_segment = 1;
  s.joints = {joint};
  s.time = {60.0, 0.0, 4};
  s.allocate_centres();
  return s;
}

TEST(Skeleton, StartsUndetermined) {
  const Skeleton s = elbow();
  EXPECT_TRUE(s.validate());
  EXPECT_EQ(s.state[s.index(3, 0)], CentreState::undetermined);
  EXPECT_TRUE(s.centre(3, 0).array().isNaN().all());
}

TEST(Skeleton, GivesTheCovarianceAsAMatrix) {
  Skeleton s = elbow();
  for (int k = 0; k < 6; ++k) s.covariance[6 * s.index(2, 0) + static_cast<std::size_t>(k)] = k + 1;
  EXPECT_EQ(s.centre_covariance(2, 0), (Eigen::Matrix3d{{1, 2, 3}, {2, 4, 5}, {3, 5, 6}}));
}

TEST(Skeleton, RefusesCentresThatContradictTheirState) {
  Skeleton s = elbow();
  s.state[1] = CentreState::determined;
  auto status = s.validate();
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("joint 'elbow' in frame 1 has the state determined"));
  s = elbow();
  s.centre_in_world[0] = 1.0;
  EXPECT_FALSE(s.validate());
}

TEST(Skeleton, RefusesIndicesOutOfRangeAndNamesUsedTwice) {
  Skeleton s = elbow();
  s.segments[1].markers = {3};
  EXPECT_FALSE(s.validate());
  s = elbow();
  s.segments[1].name = "upper";
  EXPECT_FALSE(s.validate());
  s = elbow();
  s.segments[0].x_in_segment.resize(3, 1);
  EXPECT_FALSE(s.validate());
  s = elbow();
  s.joints[0].child_segment = 0;
  EXPECT_FALSE(s.validate());
  s = elbow();
  s.lengths = {{"forearm", 0, 1, 0.2, 0.001}};
  EXPECT_FALSE(s.validate());
  s = elbow();
  s.state.pop_back();
  EXPECT_FALSE(s.validate());
}

TEST(SegmentLayout, TakesATreeAndNothingElse) {
  const SegmentLayout arm{{{"upper", {0, 1}}, {"lower", {2}}, {"hand", {3}}},
                          {{"elbow", 0, 1}, {"wrist", 1, 2}}};
  EXPECT_TRUE(arm.validate(4));
  EXPECT_FALSE(arm.validate(3)) << "marker 3 is out of range";
  SegmentLayout other = arm;
  other.joints.push_back({"ring", 2, 0});
  EXPECT_THAT(other.validate(4).error().message, HasSubstr("joint 'ring' closes a circle"));
  other = arm;
  other.segments[1].markers = {1};
  EXPECT_THAT(other.validate(4).error().message, HasSubstr("marker 1 is on 'lower'"));
  other = arm;
  other.segments[1].markers = {};
  EXPECT_FALSE(other.validate(4));
  other = arm;
  other.joints[1].name = "elbow";
  EXPECT_FALSE(other.validate(4));
}

TEST(SegmentLayout, EveryBrokenRuleIsNamed) {
  const SegmentLayout arm{{{"upper", {0, 1}}, {"lower", {2}}}, {{"elbow", 0, 1}}};
  const auto verdict = [&](auto&& spoil) {
    SegmentLayout layout = arm;
    spoil(layout);
    const auto status = layout.validate(3);
    return status ? std::string("valid") : status.error().message;
  };
  EXPECT_EQ(verdict([](SegmentLayout&) {}), "valid");
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.segments[1].name = "upper"; }),
              HasSubstr("'upper' is empty or used twice"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.segments[0].name.clear(); }), HasSubstr("'' is empty"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.segments[0].markers.clear(); }),
              HasSubstr("'upper' has no markers"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.segments[0].markers = {-1}; }),
              HasSubstr("names marker -1 of 3"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.segments[0].markers = {0, 0}; }),
              HasSubstr("marker 0 is on 'upper' and on another"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.joints[0].name.clear(); }), HasSubstr("joint name ''"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.joints[0].child = 2; }),
              HasSubstr("joins segments 0 and 2 of 2"));
  EXPECT_THAT(verdict([](SegmentLayout& l) { l.joints[0].child = 0; }), HasSubstr("circle"))
      << "a segment joined to itself";
  EXPECT_EQ(verdict([](SegmentLayout& l) { l.joints.clear(); }), "valid") << "segments may lie apart";
}

TEST(SegmentLayout, EndsAreOnTheirSegmentsAndHaveNamesOfTheirOwn) {
  SegmentLayout arm{{{"upper", {0, 1}}, {"lower", {2}}}, {{"elbow", 0, 1}}};
  arm.ends = {{.name = "shoulder", .segment = "upper"}, {.name = "wrist", .segment = "lower", .marker = 2}};
  EXPECT_TRUE(arm.validate(3));
  EXPECT_TRUE(arm.ends[0].stays());
  EXPECT_FALSE(arm.ends[1].stays());
  const auto verdict = [&](auto&& spoil) {
    SegmentLayout layout = arm;
    spoil(layout.ends[1]);
    const auto status = layout.validate(3);
    return status ? std::string("valid") : status.error().message;
  };
  EXPECT_THAT(verdict([](SegmentLayout::End& e) { e.name = "elbow"; }), HasSubstr("'elbow' of an end"));
  EXPECT_THAT(verdict([](SegmentLayout::End& e) { e.name = "shoulder"; }), HasSubstr("empty or used twice"));
  EXPECT_THAT(verdict([](SegmentLayout::End& e) { e.segment = "hand"; }),
              HasSubstr("'hand', which is no segment"));
  EXPECT_THAT(verdict([](SegmentLayout::End& e) { e.marker = 1; }),
              HasSubstr("the marker of 'wrist' is not on"));
}

TEST(Skeleton, NamesItsWords) {
  EXPECT_EQ(to_string(SegmentKind::plane), "plane");
  EXPECT_EQ(to_string(JointKind::hinge), "hinge");
  EXPECT_EQ(to_string(CentreState::bridged), "bridged");
}

}  // namespace
}  // namespace kinemark::data
