// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/segments_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using enum io::VskJointKind;

/// Pelvis, femur, tibia with a turned part fixed to it, foot; a trunk that is free; a wrist that slides.
io::Vsk leg() {
  io::Vsk out;
  out.segments = {{"pelvis", -1, "world", free}, {"femur", 0, "hip", ball},     {"tibia", 1, "knee", hinge},
                  {"turned", 2, "", fixed},      {"foot", 3, "", hardy_spicer}, {"trunk", 0, "back", free},
                  {"rod", 0, "slide", slider}};
  out.markers = {{"ASI", 0}, {"PSI", 0}, {"THI", 1}, {"TIB", 2},
                 {"ANK", 3}, {"HEE", 4}, {"C7", 5},  {"ROD", 6}};
  return out;
}

std::vector<std::string> joint_names(const data::SegmentLayout& layout) {
  std::vector<std::string> out;
  for (const auto& joint : layout.joints)
    out.push_back(joint.name + ": " + layout.segments[static_cast<std::size_t>(joint.parent)].name + ", " +
                  layout.segments[static_cast<std::size_t>(joint.child)].name);
  return out;
}

TEST(VskLayout, FixedSegmentsAreOneAndFreeOnesHaveNoJoint) {
  std::vector<std::string> warnings;
  const auto layout = layout_of(leg(), {"HEE", "ANK", "TIB", "THI", "PSI", "ASI", "C7", "ROD"}, warnings);
  ASSERT_TRUE(layout) << layout.error().message;
  ASSERT_EQ(layout->segments.size(), 6U);
  EXPECT_EQ(layout->segments[2].name, "tibia");
  EXPECT_THAT(layout->segments[2].markers, ElementsAre(2, 1)) << "with those of the part fixed to it";
  EXPECT_THAT(layout->segments[0].markers, ElementsAre(5, 4));
  EXPECT_THAT(joint_names(*layout),
              ElementsAre("hip: pelvis, femur", "knee: femur, tibia", "tibia-foot: tibia, foot"));
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_THAT(warnings, Not(Contains(HasSubstr("Not in the recording:"))));
}

TEST(VskLayout, ASubjectsPrefixAndMarkersThatAreNotThere) {
  std::vector<std::string> warnings;
  const auto layout = layout_of(leg(), {"Ann:ASI", "Ann:THI", "Ann:ANK", "stylus"}, warnings);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_THAT(joint_names(*layout), ElementsAre("hip: pelvis, femur", "knee: femur, tibia"));
  EXPECT_THAT(warnings,
              ElementsAre("Not in the recording: 5 of the 8 markers of the subject: PSI, TIB, HEE, C7, "
                          "ROD."));
}

TEST(VskLayout, ASegmentWithoutMarkersBreaksTheChain) {
  std::vector<std::string> warnings;
  const auto layout = layout_of(leg(), {"ASI", "TIB", "HEE"}, warnings);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_THAT(joint_names(*layout), ElementsAre("tibia-foot: tibia, foot"));
}

TEST(VskLayout, SaysWhatIsWrong) {
  std::vector<std::string> warnings;
  const auto none = layout_of(leg(), {"ASI", "C7"}, warnings);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_THAT(none.error().message, HasSubstr("no joint lies between two segments"));
  EXPECT_THAT(none.error().message, HasSubstr("it has 2 of the 8 markers"));
  const auto two = layout_of(leg(), {"Ann:ASI", "Bob:ASI", "Ann:THI"}, warnings);
  ASSERT_FALSE(two);
  EXPECT_THAT(two.error().message, HasSubstr("more than one marker in the recording is called 'ASI'"));
}

const std::vector<std::string> kMarkers = {"Ann:WRA", "Ann:WRB", "Ann:ELB", "SHO",    "UPA",
                                           "Bob:UPA", "a\"b\\c", "Ann:FIN", "Bob:FIN"};

constexpr const char* kArm = R"(
[[segment]]
name = "upper"
markers = ["SHO", "UPA"]
[[segment]]
name = "fore"
markers = ["WRA", "Ann:WRB", "ELB"]
)";

TEST(SegmentsFile, ReadsNamesWithAndWithoutPrefix) {
  const auto layout = parse_segments(kArm, "arm.toml", kMarkers);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->segments[0].markers, (std::vector<int>{3, 4}));
  EXPECT_EQ(layout->segments[1].markers, (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(layout->joints.size(), 1U) << "in the order given where no joint is named";
  EXPECT_EQ(layout->joints[0].name, "upper-fore");
}

TEST(SegmentsFile, JointsAreNamed) {
  const auto layout = parse_segments(
      std::string(kArm) + "[[joint]]\nname = \"elbow\"\nparent = \"fore\"\nchild = \"upper\"\n", "arm.toml",
      kMarkers);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->joints[0].name, "elbow");
  EXPECT_EQ(layout->joints[0].parent, 1);
  EXPECT_EQ(layout->joints[0].child, 0);
}

TEST(SegmentsFile, WhatIsWrittenReadsBack) {
  data::SegmentLayout layout;
  layout.segments = {{"one \"a\"", {0, 6}}, {"two", {3}}, {"three", {4}}};
  layout.joints = {{"j1", 2, 0}, {"j2", 2, 1}};
  const auto back = parse_segments(segments_text(layout, kMarkers), "x.toml", kMarkers);
  ASSERT_TRUE(back) << back.error().message;
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(back->segments[s].name, layout.segments[s].name);
    EXPECT_EQ(back->segments[s].markers, layout.segments[s].markers);
  }
  EXPECT_EQ(back->joints[1].child, 1);
}

void expect_refused(const std::string& text, const std::string& message) {
  const auto layout = parse_segments(text, "arm.toml", kMarkers);
  ASSERT_FALSE(layout) << text;
  EXPECT_EQ(layout.error().code, Code::bad_input);
  EXPECT_EQ(layout.error().message.rfind("arm.toml", 0), 0U) << layout.error().message;
  EXPECT_NE(layout.error().message.find(message), std::string::npos) << layout.error().message;
}

TEST(SegmentsFile, OneSentenceForWhatIsWrong) {
  const std::string arm = kArm;
  expect_refused("[[segment", "line 1");
  expect_refused("", "no [[segment]]");
  expect_refused("segment = 3", "'segment'");
  expect_refused("[[bone]]\nname = \"x\"", "'bone'");
  expect_refused("[[segment]]\nname = \"a\"", "markers");
  expect_refused("[[segment]]\nmarkers = [\"SHO\"]", "needs a name");
  expect_refused("[[segment]]\nname = \"a\"\nmarkers = [\"SHO\"]\ncolour = 1", "'colour'");
  expect_refused("[[segment]]\nname = \"a\"\nmarkers = [7]", "must be names");
  expect_refused("[[segment]]\nname = \"a\"\nmarkers = [\"KNE\"]",
                 "no marker in the recording is called 'KNE'; it has Ann:WRA, Ann:WRB");
  expect_refused("[[segment]]\nname = \"a\"\nmarkers = [\"FIN\"]",
                 "more than one marker in the recording is called 'FIN'; it has Ann:FIN, Bob:FIN (");
  expect_refused("[[segment]]\nname = \"a\"\nmarkers = [\"SHO\", \"SHO\"]", "on 'a' and on another");
  expect_refused(arm + "[[joint]]\nparent = \"fore\"\nchild = \"hand\"\n", "no segment is called 'hand'");
  expect_refused(arm + "[[joint]]\nparent = \"fore\"\n", "child");
  expect_refused(arm + "[[joint]]\nparent = \"fore\"\nchild = \"fore\"\n", "circle");
}

TEST(SegmentsFile, NamesWithLineEndsAndOtherControlCharactersAreReadBack) {
  const std::vector<std::string> markers = {"a\tb", "c"};
  const auto layout =
      parse_segments("[[segment]]\nname = \"one\\ntwo\\u007F\"\nmarkers = [\"a\\tb\"]\n", "x.toml", markers);
  ASSERT_TRUE(layout) << layout.error().message;
  const auto back = parse_segments(segments_text(*layout, markers), "x.toml", markers);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->segments[0].name, "one\ntwo\x7F");
  EXPECT_EQ(back->segments[0].markers, std::vector<int>{0});
}

TEST(SegmentsFile, FixedJointsAndEndsComeBack) {
  const std::vector<std::string> markers{"a", "b", "c", "d"};
  const std::string segments =
      "[[segment]]\nname = \"upper\"\nmarkers = [\"a\", \"b\"]\n"
      "[[segment]]\nname = \"fore\"\nmarkers = [\"c\", \"d\"]\n";
  const auto layout =
      parse_segments(segments +
                         "[[joint]]\nname = \"shoulder\"\nparent = \"ground\"\nchild = \"upper\"\n"
                         "[[end]]\nname = \"wrist\"\nsegment = \"fore\"\nmarker = \"d\"\n",
                     "arm.toml", markers);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_THAT(joint_names(*layout), ElementsAre("upper-fore: upper, fore")) << "in the order given";
  ASSERT_EQ(layout->ends.size(), 2U);
  EXPECT_EQ(layout->ends[0].name, "shoulder");
  EXPECT_TRUE(layout->ends[0].stays());
  EXPECT_EQ(layout->ends[1].marker, 3);
  const auto again = parse_segments(segments_text(*layout, markers), "again", markers);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(segments_text(*again, markers), segments_text(*layout, markers));
  EXPECT_EQ(again->ends.size(), 2U);
  const auto said = [&](const std::string& more) {
    return parse_segments(segments + more, "arm.toml", markers).error().message;
  };
  EXPECT_THAT(said("[[end]]\nname = \"wrist\"\nsegment = \"fore\"\nmarker = \"a\"\n"),
              HasSubstr("arm.toml: end 1: 'a' is no marker of segment 'fore'"));
  EXPECT_THAT(said("[[end]]\nname = \"wrist\"\nsegment = \"hand\"\nmarker = \"a\"\n"),
              HasSubstr("end 1: no segment is called 'hand'"));
  EXPECT_THAT(said("[[joint]]\nparent = \"ground\"\nchild = \"hand\"\n"),
              HasSubstr("no segment is called 'hand'"));
  EXPECT_THAT(said("[[joint]]\nparent = \"upper\"\nchild = \"ground\"\n"),
              HasSubstr("no segment is called 'ground'"));
}

TEST(SegmentsFile, ASegmentMayBeCalledGround) {
  const auto layout = parse_segments(
      "[[segment]]\nname = \"ground\"\nmarkers = [\"a\"]\n[[segment]]\nname = \"fore\"\nmarkers = [\"b\"]\n"
      "[[joint]]\nparent = \"ground\"\nchild = \"fore\"\n",
      "arm.toml", {"a", "b"});
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_THAT(joint_names(*layout), ElementsAre("ground-fore: ground, fore"));
  EXPECT_THAT(layout->ends, IsEmpty());
}

}  // namespace

}  // namespace kinemark::pipeline
