// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/joints_layout.h"

#include <gtest/gtest.h>

#include <string>

#include "kinemark/stages/simulation/limb.h"

namespace kinemark::workflow {
namespace {

skeleton::Implausible implausible(bool is_segment, const std::string& name,
                                  std::vector<std::string> markers) {
  return {.is_segment = is_segment,
          .name = name,
          .other = {},
          .figure = is_segment ? skeleton::BodyFigure::shape : skeleton::BodyFigure::gap,
          .value_m = 0.08,
          .least_m = 0.0,
          .most_m = 0.02,
          .markers = std::move(markers)};
}

data::SegmentLayout three_segments() {
  data::SegmentLayout out;
  out.segments = {{"pelvis", {0, 1, 2}}, {"thigh", {3, 4, 5}}, {"shank", {6, 7, 8}}};
  out.joints = {{"hip", 0, 1}, {"knee", 1, 2}};
  return out;
}

TEST(LeaveOut, TheRestIsKeptAndWhereNothingIsTheFirstWordIsTheWorst) {
  JointsOptions options;
  options.segments = three_segments();
  auto layout = three_segments();
  JointsFound outcome;
  const std::vector knee{implausible(false, "knee", {"T1", "S1"})};
  ASSERT_TRUE(leave_out(options, knee, layout, outcome));
  EXPECT_EQ(layout.joints.size(), 1U);
  EXPECT_EQ(outcome.left_out.size(), 1U);
  auto last = implausible(false, "hip", {"P1", "T1"});
  last.value_m = 0.3;
  const auto refused = leave_out(options, std::vector{last}, layout, outcome);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  const std::string& message = refused.error().message;
  EXPECT_TRUE(message.contains("no joint of a body can be found: joint 'hip'")) << message;
  EXPECT_TRUE(message.contains(", and 1 more such segments or joints were left out; look at the markers"))
      << message;
  // One alone has no others.
  data::SegmentLayout one = three_segments();
  one.segments.pop_back();
  one.joints.pop_back();
  JointsFound single;
  const auto alone = leave_out(options, std::vector{last}, one, single);
  ASSERT_FALSE(alone);
  EXPECT_FALSE(alone.error().message.contains("more such segments or joints were left out"));
}

TEST(LeaveOut, OfSegmentsThatNobodyNamedNothingWasAsked) {
  auto layout = three_segments();
  JointsFound outcome;
  outcome.segmentation.emplace();
  EXPECT_TRUE(leave_out({}, std::vector{implausible(true, "thigh", {"T1"})}, layout, outcome));
  EXPECT_TRUE(layout.joints.empty());
  EXPECT_EQ(outcome.left_out.size(), 1U);
}

TEST(WithLeftOut, AnErrorNamesWhatIsMissing) {
  JointsFound outcome;
  const Error error{Code::bad_input, "nothing is left"};
  EXPECT_EQ(with_left_out(outcome, error).message, "nothing is left");
  EXPECT_FALSE(with_left_out(outcome, error).message.contains("(left out, as they are no body's:"));
  outcome.left_out = {implausible(true, "thigh", {"T1"}), implausible(false, "knee", {"S1"})};
  EXPECT_EQ(with_left_out(outcome, error).message,
            "nothing is left (left out, as they are no body's: 'thigh', 'knee')");
  EXPECT_EQ(with_left_out(outcome, error).code, Code::bad_input);
}

TEST(ProposeNextStep, FitsWhereTheSegmentsCameFrom) {
  JointsOptions unnamed, named;
  named.segments = three_segments();
  JointsFound joint, segment, both;
  joint.left_out = {implausible(false, "knee", {"T1", "S1"})};
  segment.left_out = {implausible(true, "thigh", {"T1", "T2"})};
  both.left_out = {implausible(true, "thigh", {"T1", "T2", "T1"}), implausible(false, "knee", {"S1"}),
                   implausible(false, "hip", {"P1"})};
  EXPECT_EQ(propose_next_step(unnamed, joint), "Name the segments of the body in a file (--segments).");
  EXPECT_EQ(propose_next_step(unnamed, segment),
            "Name the segments of the body in a file (--segments), without the markers T1 and T2.");
  EXPECT_FALSE(propose_next_step(unnamed, joint).contains("Look at the markers of both segments of"));
  EXPECT_EQ(propose_next_step(named, joint),
            "Look at the markers of both segments of 'knee', or leave this joint out of the segments file.");
  EXPECT_FALSE(
      propose_next_step(named, joint).contains("Name the segments of the body in a file (--segments)"));
  EXPECT_EQ(propose_next_step(named, segment), "Name the segments, without the markers T1 and T2.");
  EXPECT_EQ(
      propose_next_step(named, both),
      "Look at the markers of both segments of 'knee' and 'hip', or leave these joints out of the segments "
      "file, without the markers T1 and T2.");
}

TEST(TreesOf, SegmentsWithoutAJointAreNoTree) {
  auto layout = three_segments();
  EXPECT_EQ(trees_of(layout).size(), 1U);
  layout.segments.push_back({"arm", {9}});
  layout.segments.push_back({"hand", {10}});
  layout.segments.push_back({"alone", {11}});
  layout.joints.push_back({"wrist", 3, 4});
  const auto trees = trees_of(layout);
  ASSERT_EQ(trees.size(), 2U);
  EXPECT_EQ(trees[0].joints.size(), 2U);
  EXPECT_EQ(trees[1].segments[0].name, "arm");
  EXPECT_EQ(trees[1].joints[0].child, 1);
}

/// A subject of a chain of three segments, with as many markers on each as are asked for.
class SubjectLayout : public ::testing::Test {
 protected:
  data::Trajectories make(const std::vector<std::size_t>& markers_on) {
    auto recording =
        simulation::simulate_chain(
            {.frames = 60, .lengths_m = {0.12, 0.15, 0.16}, .markers_per_segment = 4, .stagger_m = 0.03})
            .value();
    for (std::size_t s = 0; s < 3; ++s) recording.layout.segments[s].markers.resize(markers_on[s]);
    last = recording.layout.segments[2].name;
    options.segments = recording.layout;
    options.of_subject = true;
    return recording.markers;
  }
  std::string last;  ///< name of the last segment
  JointsOptions options;
  JointsFound outcome;
};

TEST_F(SubjectLayout, SegmentsOfOneMarkerAreNothingForTheArticulatedMethod) {
  const auto markers = make({1, 1, 1});
  const auto refused = lay_out(options, markers, outcome);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(
      refused.error().message.contains("none of the 2 joints lies between two segments of two "
                                       "markers or more, which the articulated "
                                       "method needs; name the segments in a file, or use another method"))
      << refused.error().message;
  options.method = "score";
  const auto taken = lay_out(options, markers, outcome);
  EXPECT_FALSE(!taken && taken.error().message.contains("lies between two segments of two markers or more"));
}

TEST_F(SubjectLayout, WhatIsLeftOutOfASubjectIsSaid) {
  auto markers = make({4, 4, 1});
  ASSERT_TRUE(lay_out(options, markers, outcome));
  ASSERT_EQ(outcome.remarks.warnings.size(), 1U);
  EXPECT_EQ(outcome.remarks.warnings[0],
            "Left out, as the articulated method needs two markers on a segment and on one beside it: " +
                last + ".");
  EXPECT_EQ(outcome.layout.joints.size(), 1U);
  markers = make({4, 4, 2});
  JointsFound whole;
  ASSERT_TRUE(lay_out(options, markers, whole));
  for (const auto& warning : whole.remarks.warnings)
    EXPECT_FALSE(warning.contains("Left out, as the articulated method needs two markers on a segment"));
  EXPECT_EQ(whole.layout.joints.size(), 2U);
}

TEST(LayOut, ThreeMarkersAreTooFew) {
  JointsFound outcome;
  const auto none = lay_out(
      {}, data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 10}),
      outcome);
  ASSERT_FALSE(none);
  EXPECT_TRUE(none.error().message.starts_with("3 markers in all;")) << none.error().message;
}

}  // namespace
}  // namespace kinemark::workflow
