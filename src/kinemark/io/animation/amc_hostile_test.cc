// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// ASF and AMC files that lie, stop or are too much: one sentence, with the file and the line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "kinemark/io/animation/amc.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;

const std::string kSkeleton =
    ":units\nlength 1\nangle deg\n:root\norder TX TY TZ RX RY RZ\naxis XYZ\nposition 0 0 0\norientation 0 0 "
    "0\n:bonedata\n"
    "begin\nname a\ndirection 0 1 0\nlength 170\naxis 0 0 0 XYZ\ndof rx\nend\n:hierarchy\nbegin\nroot "
    "a\nend\n";
const std::string kFrames = ":DEGREES\n1\nroot 0 0 0 0 0 0\na 1\n2\nroot 0 0 0 0 0 0\na 2\n";

std::string sentence(const std::string& amc, const std::optional<std::string>& asf,
                     Code code = Code::bad_input) {
  const auto trial = parse_amc(amc, "h.amc", asf, "h.asf", 120.0);
  EXPECT_FALSE(trial) << amc.substr(0, 200) << asf.value_or("").substr(0, 400);
  if (trial) return "";
  EXPECT_EQ(trial.error().code, code);
  EXPECT_EQ(trial.error().message.find('\n'), std::string::npos);
  return trial.error().message;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string of_skeleton(const std::string& from, const std::string& to, Code code = Code::bad_input) {
  const std::string message = sentence(kFrames, changed(kSkeleton, from, to), code);
  EXPECT_THAT(message, testing::StartsWith("h.asf: "));
  return message;
}

std::string of_frames(const std::string& from, const std::string& to) {
  const std::string message = sentence(changed(kFrames, from, to), kSkeleton);
  EXPECT_THAT(message, testing::StartsWith("h.amc: "));
  return message;
}

TEST(HostileAmc, TheUnchangedFilesAreGood) {
  ASSERT_TRUE(parse_amc(kFrames, "h.amc", kSkeleton, "h.asf", 120.0));
}

TEST(HostileAmc, TheSkeletonIsCheckedLineByLine) {
  EXPECT_THAT(of_skeleton(":units\n", ""), HasSubstr("line 1: 'length'; expected a section"));
  EXPECT_THAT(of_skeleton("length 1\n", "length one\n"), HasSubstr("line 2: the length is 'one'"));
  EXPECT_THAT(of_skeleton("length 1\n", "length 0\n"), HasSubstr("expected more than 0"));
  EXPECT_THAT(of_skeleton("order TX", "order QX"), HasSubstr("line 5: 'qx'; expected rx"));
  EXPECT_THAT(of_skeleton("order TX TY TZ RX RY RZ\n", ""), HasSubstr("no :root with its order"));
  EXPECT_THAT(of_skeleton("position 0 0 0", "position 0 0"),
              HasSubstr("ends before number 3 of the position"));
  EXPECT_THAT(of_skeleton("begin\nname a", "name a"), HasSubstr("line 10: 'name'; expected begin"));
  EXPECT_THAT(of_skeleton("name a\n", "name a\nbegin\n"), HasSubstr("begin within begin"));
  EXPECT_THAT(of_skeleton("name a\n", ""), HasSubstr("line 10: this bone has no name"));
  EXPECT_THAT(of_skeleton("name a\n", "name root\n"), HasSubstr("bone 'root' occurs twice"));
  EXPECT_THAT(of_skeleton("direction 0 1 0", "direction 0 up 0"),
              HasSubstr("number 2 of the direction is 'up'"));
  EXPECT_THAT(of_skeleton("axis 0 0 0 XYZ\ndof", "axis 0 0 0 XYW\ndof"), HasSubstr("order of axes 'XYW'"));
  EXPECT_THAT(of_skeleton("dof rx", "dof rx ry rz rx"), HasSubstr("more than three rotations"));
  EXPECT_THAT(of_skeleton("dof rx", "dof l", Code::not_supported), HasSubstr("changes its length"));
  EXPECT_THAT(of_skeleton("root a", "root b"), HasSubstr("there is no bone 'b'"));
  EXPECT_THAT(of_skeleton("root a", "root a a"), HasSubstr("hangs from a second one"));
  EXPECT_THAT(of_skeleton("root a", "a a"), HasSubstr("in a circle"));
  EXPECT_THAT(of_skeleton("root a\n", ""), HasSubstr("line 10: bone 'a' hangs from nothing"));
  EXPECT_THAT(sentence(kFrames, kSkeleton.substr(0, kSkeleton.find("dof"))),
              HasSubstr("the file ends within begin and end"));
  EXPECT_THAT(sentence(kFrames, ""), HasSubstr("h.asf: "));
}

TEST(HostileAmc, TheMotionIsCheckedLineByLine) {
  EXPECT_THAT(sentence("", kSkeleton), HasSubstr("before the first frame"));
  EXPECT_THAT(of_frames("1\nroot", "root"), HasSubstr("line 2: 'root'; expected the number of a frame"));
  EXPECT_THAT(of_frames("a 1", "b 1"), HasSubstr("line 4: 'b' is no bone that moves in the skeleton"));
  EXPECT_THAT(of_frames("a 1", "a 1 2"), HasSubstr("line 4: 2 numbers of 'a'; expected 1"));
  EXPECT_THAT(of_frames("a 1", "a"), HasSubstr("line 4: 0 numbers of 'a'"));
  EXPECT_THAT(of_frames("a 1", "a one"), HasSubstr("line 4: number 1 of 'a' is 'one'"));
  EXPECT_THAT(of_frames("a 1", "a nan"), HasSubstr("expected a number"));
  EXPECT_THAT(of_frames("1\nroot", "99999999999999999999\nroot"),
              HasSubstr("expected a number of up to 12 digits"));
  EXPECT_THAT(sentence(changed(kFrames, "a 2", "b 2"), std::nullopt),
              HasSubstr("'b' is no bone that moves in the first frame"));
}

TEST(HostileAmc, FramesMustBeInTheFile) {
  std::string empty_frames;
  for (int f = 0; f < 300'000; ++f) empty_frames += "1\n";
  EXPECT_THAT(sentence(empty_frames, kSkeleton), HasSubstr("do not fit into the 600000 bytes"));
  std::string wide = kSkeleton;
  for (int b = 0; b < 20'000; ++b) wide += ":bonedata\nbegin\nname b" + std::to_string(b) + "\nend\n";
  EXPECT_THAT(sentence(kFrames, wide), HasSubstr("more than 10000 bones"));
}

TEST(HostileAmc, ALongChainIsNoDepthOfCalls) {
  std::string asf = kSkeleton.substr(0, kSkeleton.find(":hierarchy")),
              hierarchy = ":hierarchy\nroot a\na b0\n";
  for (int b = 0; b < 9'000; ++b) {
    asf += "begin\nname b" + std::to_string(b) + "\nlength 0\ndirection 0 0 1\nend\n";
    if (b > 0) hierarchy += "b" + std::to_string(b - 1) + " b" + std::to_string(b) + "\n";
  }
  EXPECT_TRUE(parse_amc(kFrames, "h.amc", asf + hierarchy, "h.asf", 120.0));
}

TEST(HostileAmc, HugeNumbersAreMissingNotInfinite) {
  const auto trial = parse_amc(changed(kFrames, "root 0 0 0", "root 1e308 1e308 1e308"), "h.amc",
                               changed(kSkeleton, "length 170", "length 1e308"), "h.asf", 120.0)
                         .value();
  EXPECT_TRUE(trial.validate());
}

}  // namespace
}  // namespace kinemark::io
