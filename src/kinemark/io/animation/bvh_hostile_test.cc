// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// BVH files that lie, stop or are too much: one sentence, with the line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/animation/bvh.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;

const std::string kTree =
    "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  CHANNELS 3 Xposition Yposition Zrotation\n"
    "  End Site\n  {\n    OFFSET 0 100 0\n  }\n}\n";
const std::string kMotion = "MOTION\nFrames: 2\nFrame Time: 0.01\n1 2 3\n4 5 6\n";

std::string sentence(const std::string& text) {
  const auto trial = parse_bvh(text, "h.bvh");
  EXPECT_FALSE(trial) << text.substr(0, 300);
  if (trial) return "";
  EXPECT_EQ(trial.error().code, Code::bad_input);
  EXPECT_EQ(trial.error().message.find('\n'), std::string::npos);
  EXPECT_THAT(trial.error().message, HasSubstr("h.bvh: "));
  return trial.error().message;
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kTree + kMotion;
  return text.replace(text.find(from), from.size(), to);
}

TEST(HostileBvh, TheUnchangedFileIsGood) { ASSERT_TRUE(parse_bvh(kTree + kMotion, "h.bvh")); }

TEST(HostileBvh, TheHierarchyIsCheckedLineByLine) {
  EXPECT_THAT(sentence(""), HasSubstr("line 1: ''; expected HIERARCHY"));
  EXPECT_THAT(sentence("solid\n"), HasSubstr("line 1: 'solid'; expected HIERARCHY"));
  EXPECT_THAT(sentence("HIERARCHY\n"), HasSubstr("the file ends; expected MOTION"));
  EXPECT_THAT(sentence("HIERARCHY\n" + kMotion), HasSubstr("expected a ROOT"));
  EXPECT_THAT(sentence(changed("ROOT Hips\n{", "ROOT Hips\n")),
              HasSubstr("line 4: 'OFFSET'; expected the '{' that opens 'Hips'"));
  EXPECT_THAT(sentence(changed("}\nMOTION", "\nMOTION")), HasSubstr("expected the '}' that closes 'Hips'"));
  EXPECT_THAT(sentence(changed("}\nMOTION", "}\n}\nMOTION")), HasSubstr("line 11: a '}' too many"));
  EXPECT_THAT(sentence(changed("OFFSET 0 0 0", "OFFSET 0 zero 0")),
              HasSubstr("line 4: y of the offset is 'zero'"));
  EXPECT_THAT(sentence(changed("OFFSET 0 0 0", "OFFSET 0 0")),
              HasSubstr("line 4: ends before z of the offset"));
  EXPECT_THAT(sentence(changed("OFFSET 0 0 0", "OFFSET 0 0 inf")), HasSubstr("expected a number"));
  EXPECT_THAT(sentence(changed("  OFFSET 0 0 0", "  OFFSET 0 0 0\n OFFSET 0 0 0")),
              HasSubstr("a second OFFSET"));
  EXPECT_THAT(sentence(changed("Zrotation", "Wrotation")), HasSubstr("line 5: channel 'Wrotation'"));
  EXPECT_THAT(sentence(changed("Zrotation", "Zscale")), HasSubstr("channel 'Zscale'"));
  EXPECT_THAT(sentence(changed("CHANNELS 3", "CHANNELS -3")), HasSubstr("-3 channels; expected 0 to 6"));
  EXPECT_THAT(sentence(changed("CHANNELS 3", "CHANNELS 1e9")), HasSubstr("1e+09 channels"));
  EXPECT_THAT(sentence(changed("CHANNELS 3", "CHANNELS 2.5")), HasSubstr("2.5 channels"));
  EXPECT_THAT(
      sentence(changed("CHANNELS 3", "CHANNELS 4 Zrotation Zrotation Zrotation Zrotation\nCHANNELS 3")),
      HasSubstr("4 rotations"));
  EXPECT_THAT(sentence(changed("CHANNELS 3", "CHANNELS 2")),
              HasSubstr("'Zrotation'; expected OFFSET, CHANNELS"));
  EXPECT_THAT(sentence(changed("CHANNELS 3 Xposition Yposition Zrotation", "CHANNELS 0")),
              HasSubstr("no joint has CHANNELS"));
  EXPECT_THAT(sentence(changed("  End Site", "  ROOT Other")), HasSubstr("line 6: a ROOT within a joint"));
  EXPECT_THAT(sentence(changed("End Site", "End Zone")), HasSubstr("End 'Zone'"));
  EXPECT_THAT(sentence(changed("    OFFSET 0 100 0", "    JOINT Knee {")),
              HasSubstr("a JOINT within an End Site"));
  EXPECT_THAT(sentence(changed("    OFFSET 0 100 0", "    CHANNELS 1 Zrotation")),
              HasSubstr("of an End Site"));
  EXPECT_THAT(sentence(kTree.substr(0, 37)), HasSubstr("the file ends within 'Hips'"));
}

TEST(HostileBvh, TheMotionIsCheckedRowByRow) {
  EXPECT_THAT(sentence(kTree), HasSubstr("the file ends; expected MOTION"));
  EXPECT_THAT(sentence(kTree + "MOTION\n"), HasSubstr("the file ends; expected 'Frames:'"));
  EXPECT_THAT(sentence(changed("Frames: 2", "Frame: 2")),
              HasSubstr("line 12: 'Frame: 2'; expected 'Frames:'"));
  EXPECT_THAT(sentence(changed("Frames: 2", "Frames: two")), HasSubstr("Frames: 'two'"));
  for (const char* time : {"0", "-0.01", "nan", "", "1e-9", "1e9", "fast"})
    EXPECT_THAT(sentence(changed("Frame Time: 0.01", std::string("Frame Time: ") + time)),
                HasSubstr("expected seconds"))
        << time;
  EXPECT_THAT(sentence(changed("1 2 3\n4 5 6\n", "")), HasSubstr("before the first row"));
  EXPECT_THAT(sentence(changed("1 2 3\n", "1 2\n")), HasSubstr("line 14: 2 numbers; expected 3"));
  EXPECT_THAT(sentence(changed("1 2 3\n", "1 2 3 4\n")), HasSubstr("line 14: more than 3 numbers"));
  EXPECT_THAT(sentence(changed("1 2 3\n", "1 2,5 3\n")), HasSubstr("line 14: number 2 is '2,5'"));
  EXPECT_THAT(sentence(changed("1 2 3\n4 5 6\n", "1 2\n")), HasSubstr("line 14: 2 numbers"));
}

TEST(HostileBvh, ARowThatIsCutIsLeftOutAndCountsThatLieAreSaid) {
  const auto cut = parse_bvh(changed("4 5 6\n", "4 5"), "h.bvh").value();
  EXPECT_EQ(cut.markers.frames(), 1);
  EXPECT_THAT(cut.warnings.at(0), HasSubstr("line 15: the last row ends after 2 of 3 numbers"));
  for (const char* count : {"3000000000", "-1", "0", "1e300", "2.5"}) {
    const auto trial = parse_bvh(changed("Frames: 2", std::string("Frames: ") + count), "h.bvh").value();
    EXPECT_EQ(trial.markers.frames(), 2);
    EXPECT_THAT(trial.warnings.at(0), HasSubstr("and holds 2, which are used")) << count;
  }
}

TEST(HostileBvh, NestingIsBounded) {
  const auto nested = [](int depth) {
    std::string text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int i = 1; i < depth; ++i) text += "JOINT j\n{\nOFFSET 0 1 0\nCHANNELS 0\n";
    for (int i = 0; i < depth; ++i) text += "}\n";
    return text + "MOTION\nFrames: 1\nFrame Time: 0.01\n0\n";
  };
  EXPECT_TRUE(parse_bvh(nested(1000), "h.bvh"));
  EXPECT_THAT(sentence(nested(1001)), HasSubstr("nested more than 1000 deep"));
  EXPECT_THAT(sentence(nested(300'000)), HasSubstr("nested more than 1000 deep"));
}

TEST(HostileBvh, ManyJointsInManyFramesMustBeInTheFile) {
  std::string text = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 3000; ++i) text += "JOINT j{OFFSET 0 1 0 }\n";
  text += "}\nMOTION\nFrames: 3000\nFrame Time: 0.01\n";
  for (int i = 0; i < 3000; ++i) text += "0\n";
  EXPECT_THAT(sentence(text), HasSubstr("3000 frames of 3001 joints do not fit"));
}

TEST(HostileBvh, HugeNumbersAreMissingNotInfinite) {
  const auto trial = parse_bvh(changed("1 2 3\n", "1e308 1e400 3\n"), "h.bvh").value();
  EXPECT_TRUE(trial.validate());
  EXPECT_FALSE(trial.markers.present(0, 0));
}

}  // namespace
}  // namespace kinemark::io
