// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_layout.h"

#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/file.h"
#include "kinemark/stages/simulation/limb.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
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
  JointsJob job;
  job.segments = "leg.toml";
  auto layout = three_segments();
  JointsOutcome outcome;
  const std::vector knee{implausible(false, "knee", {"T1", "S1"})};
  ASSERT_TRUE(leave_out(job, knee, layout, outcome));
  EXPECT_EQ(layout.joints.size(), 1U);
  EXPECT_EQ(outcome.left_out.size(), 1U);
  auto last = implausible(false, "hip", {"P1", "T1"});
  last.value_m = 0.3;
  const auto refused = leave_out(job, std::vector{last}, layout, outcome);
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
  JointsOutcome single;
  const auto alone = leave_out(job, std::vector{last}, one, single);
  ASSERT_FALSE(alone);
  EXPECT_FALSE(alone.error().message.contains("more such segments or joints were left out"));
}

TEST(LeaveOut, OfSegmentsThatNobodyNamedNothingWasAsked) {
  auto layout = three_segments();
  JointsOutcome outcome;
  outcome.segmentation.emplace();
  EXPECT_TRUE(leave_out({}, std::vector{implausible(true, "thigh", {"T1"})}, layout, outcome));
  EXPECT_TRUE(layout.joints.empty());
  EXPECT_EQ(outcome.left_out.size(), 1U);
}

TEST(WithLeftOut, AnErrorNamesWhatIsMissing) {
  JointsOutcome outcome;
  const Error error{Code::bad_input, "nothing is left"};
  EXPECT_EQ(with_left_out(outcome, error).message, "nothing is left");
  EXPECT_FALSE(with_left_out(outcome, error).message.contains("(left out, as they are no body's:"));
  outcome.left_out = {implausible(true, "thigh", {"T1"}), implausible(false, "knee", {"S1"})};
  EXPECT_EQ(with_left_out(outcome, error).message,
            "nothing is left (left out, as they are no body's: 'thigh', 'knee')");
  EXPECT_EQ(with_left_out(outcome, error).code, Code::bad_input);
}

TEST(ProposeNextStep, FitsWhereTheSegmentsCameFrom) {
  JointsJob unnamed, named;
  named.segments = "leg.toml";
  JointsOutcome joint, segment, both;
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

/// A subject of Vicon's of a chain of three segments, with as many markers on each as are asked for.
class SubjectLayout : public ::testing::Test {
 protected:
  data::Trajectories make(std::vector<int> markers_on) {
    auto recording =
        simulation::simulate_chain(
            {.frames = 60, .lengths_m = {0.12, 0.15, 0.16}, .markers_per_segment = 4, .stagger_m = 0.03})
            .value();
    std::string markers;
    for (std::size_t s = 0; s < 3; ++s)
      for (int k = 0; k < markers_on[s]; ++k)
        markers += "<Marker NAME=\"" +
                   recording.markers.names[static_cast<std::size_t>(
                       recording.layout.segments[s].markers[static_cast<std::size_t>(k)])] +
                   "\" POSITION=\"1 2 3\" SEGMENT=\"s" + std::to_string(s) + "\"/>";
    job.segments = scratch / "ann.vsk";
    job.input = "walk.c3d";
    EXPECT_TRUE(
        io::write_text(job.segments,
                       "<?xml version=\"1.0\"?><KinematicModel MODEL=\"Arm\"><Skeleton><Segment NAME=\"s0\">"
                       "<JointFree NAME=\"world\"/><Segment NAME=\"s1\"><JointBall NAME=\"j0\"/><Segment "
                       "NAME=\"s2\"><JointBall NAME=\"j1\"/></Segment></Segment></Segment></Skeleton>"
                       "<MarkerSet><Markers>" +
                           markers + "</Markers></MarkerSet></KinematicModel>",
                       true));
    return recording.markers;
  }
  testing_support::ScratchFolder scratch;
  JointsJob job;
  JointsOutcome outcome;
};

TEST_F(SubjectLayout, SegmentsOfOneMarkerAreNothingForTheArticulatedMethod) {
  const auto markers = make({1, 1, 1});
  EXPECT_TRUE(is_subject(job));
  const auto refused = lay_out(job, markers, outcome);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(
      refused.error().message.contains("walk.c3d: none of the 2 joints lies between two segments of two "
                                       "markers or more, which the articulated "
                                       "method needs; name the segments in a file, or use another method"))
      << refused.error().message;
  job.method = "score";
  const auto taken = lay_out(job, markers, outcome);
  EXPECT_FALSE(!taken && taken.error().message.contains("lies between two segments of two markers or more"));
}

TEST_F(SubjectLayout, WhatIsLeftOutOfASubjectIsSaid) {
  auto markers = make({4, 4, 1});
  ASSERT_TRUE(lay_out(job, markers, outcome));
  ASSERT_EQ(outcome.warnings.size(), 1U);
  EXPECT_EQ(outcome.warnings[0],
            "Left out, as the articulated method needs two markers on a segment and on one beside it: s2.");
  EXPECT_EQ(outcome.layout.joints.size(), 1U);
  markers = make({4, 4, 2});
  JointsOutcome whole;
  ASSERT_TRUE(lay_out(job, markers, whole));
  for (const auto& warning : whole.warnings)
    EXPECT_FALSE(warning.contains("Left out, as the articulated method needs two markers on a segment"));
  EXPECT_EQ(whole.layout.joints.size(), 2U);
}

TEST(LayOut, ThreeMarkersAreTooFew) {
  JointsJob job;
  job.input = "walk.c3d";
  JointsOutcome outcome;
  const auto none = lay_out(
      job, data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 10}),
      outcome);
  ASSERT_FALSE(none);
  EXPECT_TRUE(none.error().message.starts_with("walk.c3d: 3 markers in all;")) << none.error().message;
}

}  // namespace
}  // namespace kinemark::pipeline
