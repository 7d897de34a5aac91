// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/segments_file.h"

#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

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

}  // namespace
}  // namespace kinemark::pipeline
