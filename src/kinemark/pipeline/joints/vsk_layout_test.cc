// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/vsk_layout.h"

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

}  // namespace
}  // namespace kinemark::pipeline
