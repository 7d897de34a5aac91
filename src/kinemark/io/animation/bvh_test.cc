// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A trunk of 100 units with an arm of 70; parts can be another.
struct Text {
  std::string root_channels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";
  std::string arm = "  JOINT Arm\n  {\n    OFFSET 0 100 0\n    CHANNELS 3 Zrotation Xrotation Yrotation\n";
  std::string end = "    End Site\n    {\n      OFFSET 70 0 0\n    }\n  }\n}\n";
  std::string frames = "Frames: 2\n";
  std::string time = "Frame Time: 0.008333\n";
  std::string rows = "1 2 3 0 0 0 0 0 0\n0 0 0 90 0 0 0 0 90\n";

  [[nodiscard]] std::string join() const {
    return "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  " + root_channels + "\n" + arm + end + "MOTION\n" +
           frames + time + rows;
  }
};

data::Trial good(const std::string& text) {
  auto trial = parse_bvh(text, "t.bvh");
  EXPECT_TRUE(trial) << trial.error().message;
  if (!trial) return {};
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  return *trial;
}

TEST(ParseBvh, JointsAndEndSitesArePointsInMetres) {
  const auto trial = good(Text{}.join());
  EXPECT_EQ(trial.format, "BVH");
  EXPECT_EQ(trial.source, "t.bvh");
  EXPECT_EQ(trial.units_in_file, "");
  EXPECT_THAT(trial.markers.names, ElementsAre("Hips", "Arm", "Arm_end"));
  EXPECT_LT((trial.markers.x(0, 2) - Vector3d(0.71, 1.02, 0.03)).norm(), 1e-12);
  // The trunk, along y, turned a quarter about z lies along -x; the arm, along x, turned about y points to -z
  // in the trunk and so in the world.
  EXPECT_LT((trial.markers.x(1, 1) - Vector3d(-1.0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((trial.markers.x(1, 2) - Vector3d(-1.0, 0, -0.7)).norm(), 1e-12);
  EXPECT_EQ(trial.markers.count_missing(), 0);
}

TEST(ParseBvh, PositionsOfTheRootStandForItsOffsetWhereTheyAreNearIt) {
  const auto with_offset = [](const std::string& offset, const std::string& rows) {
    Text text;
    text.rows = rows;
    std::string out = text.join();
    return good(out.replace(out.find("OFFSET 0 0 0"), 12, "OFFSET " + offset));
  };
  // As LaFAN1 has it: the offset is the first position.
  const auto twice = with_offset("100 90 -500", "100 90 -500 0 0 0 0 0 0\n110 90 -500 0 0 0 0 0 0\n");
  EXPECT_LT((twice.markers.x(1, 0) - Vector3d(1.1, 0.9, -5.0)).norm(), 1e-12);
  EXPECT_THAT(twice.warnings,
              Contains(HasSubstr("positions of the root are those of its offset in the first frame")));
  // Small positions beside a large offset are beside it.
  const auto beside = with_offset("0 90 0", "1 0 0 0 0 0 0 0 0\n2 0 0 0 0 0 0 0 0\n");
  EXPECT_LT((beside.markers.x(1, 0) - Vector3d(0.02, 0.9, 0.0)).norm(), 1e-12);
  EXPECT_THAT(beside.warnings, Not(Contains(HasSubstr("its offset"))));
}

TEST(ParseBvh, AnglesAreChannelsInTheOrderOfTheFile) {
  const auto trial = good(Text{}.join());
  EXPECT_THAT(trial.channels.names, ElementsAre("Hips_angles_ZXY", "Arm_angles_ZXY"));
  EXPECT_THAT(trial.channels.units, ElementsAre("deg", "deg"));
  EXPECT_EQ(trial.channels.kinds[0], data::ChannelKind::angle);
  EXPECT_EQ(trial.channels.rate_hz, 120.0);
  EXPECT_THAT(trial.channels.values, ElementsAre(0, 0, 0, 0, 0, 0, 90, 0, 0, 0, 0, 90));
}

TEST(ParseBvh, AFrameTimeOfFewDigitsIsTheRateThatItWasRoundedFrom) {
  const auto rate = [](const std::string& time) {
    Text text;
    text.time = "Frame Time: " + time + "\n";
    return good(text.join()).markers.time.rate_hz;
  };
  EXPECT_EQ(rate("0.008333"), 120.0);
  EXPECT_EQ(rate(".0083333"), 120.0);
  EXPECT_EQ(rate("0.033333"), 30.0);
  EXPECT_EQ(rate("0.01"), 100.0);
  EXPECT_EQ(rate("0.0083340"), 1.0 / 0.008334);
  EXPECT_EQ(rate("1e-3"), 1.0 / 1e-3);
}

TEST(ParseBvh, TheUnitIsTheOneThatMakesAPerson) {
  const auto sized = [](const std::string& trunk) {
    Text text;
    text.arm = "JOINT Arm\n{\nOFFSET 0 " + trunk + " 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
    text.end = "End Site { OFFSET 0 0 0 } } }\n";
    const auto trial = good(text.join());
    return std::pair(trial.markers.x(0, 1).y() - trial.markers.x(0, 0).y(), trial.warnings.at(0));
  };
  EXPECT_NEAR(sized("1.6").first, 1.6, 1e-12);
  EXPECT_NEAR(sized("160").first, 1.6, 1e-12);
  EXPECT_NEAR(sized("1600").first, 1.6, 1e-12);
  EXPECT_NEAR(sized("60").first, 0.6, 1e-12);
  EXPECT_THAT(sized("160").second, HasSubstr("states no unit of length; cm is taken"));
  EXPECT_THAT(sized("160").second, Not(HasSubstr("no person")));
  EXPECT_THAT(sized("20").second, HasSubstr("0.2 m large: no person"));
  EXPECT_THAT(sized("0").second, HasSubstr("no person"));
}

TEST(ParseBvh, PositionsBelowTheRootAddToTheOffsetOrStandForItWhereTheyAreLikeIt) {
  Text text;
  text.arm =
      "JOINT Arm\n{\nOFFSET 0 100 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
      "Yrotation\n";
  text.rows = "0 0 0 0 0 0 1 2 0 0 0 0\n0 0 0 0 0 0 1 2 0 0 0 0\n";
  EXPECT_LT((good(text.join()).markers.x(0, 1) - Vector3d(0.01, 1.02, 0)).norm(), 1e-12);
  text.rows = "0 0 0 0 0 0 1 101 0 0 0 0\n0 0 0 0 0 0 2 102 0 0 0 0\n";
  const auto replaced = good(text.join());
  EXPECT_LT((replaced.markers.x(1, 1) - Vector3d(0.02, 1.02, 0)).norm(), 1e-12);
  EXPECT_THAT(replaced.warnings.at(0), HasSubstr("are taken in their place"));
}

TEST(ParseBvh, LayoutDoesNotMatter) {
  const auto plain = good(Text{}.join());
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : Text{}.join()) windows += c == '\n' ? "\r\n" : std::string(1, c);
  Text packed;
  packed.arm = "joint Arm{\n    OFFSET 0\t100 0 channels 3 ZROTATION xrotation Yrotation ";
  packed.end = "end site { offset 70 0 0 } } }\n\n";
  packed.rows = "\n" + packed.rows + "\n\n";
  packed.frames = "FRAMES:2\n";
  packed.time = "frame time 0.008333\n";
  for (const auto& text : {windows, packed.join()}) {
    const auto trial = good(text);
    EXPECT_EQ(trial.markers.x_in_world, plain.markers.x_in_world);
    EXPECT_EQ(trial.markers.names, plain.markers.names);
  }
}

TEST(ParseBvh, NamesWithBlanksStayAndEqualOnesGetANumber) {
  Text text;
  text.arm =
      "JOINT Left Arm\n{\nOFFSET 0 100 0\nCHANNELS 0\n}\nJOINT Left Arm {\nOFFSET 0 100 0\nCHANNELS 3 "
      "Zrotation "
      "Xrotation Yrotation\n";
  const auto trial = good(text.join());
  EXPECT_THAT(trial.markers.names, ElementsAre("Hips", "Left Arm", "Left Arm_2", "Left Arm_end"));
  EXPECT_THAT(trial.warnings.back(), HasSubstr("1 joints share a name with another ('Left Arm')"));
}

TEST(ParseBvh, SeveralSkeletonsAreAllRead) {
  const Text text;
  const std::string one = text.join();
  const auto motion = one.find("MOTION");
  const std::string tree = one.substr(10, motion - 10);
  const auto trial = good("HIERARCHY\n" + tree + tree +
                          "MOTION\nFrames: 1\nFrame Time: 0.01\n1 2 3 0 0 0 0 0 0 4 5 6 0 0 0 0 0 0\n");
  EXPECT_EQ(trial.markers.markers(), 6);
  EXPECT_LT((trial.markers.x(0, 3) - Vector3d(0.04, 0.05, 0.06)).norm(), 1e-12);
}

TEST(ParseBvh, ANumberThatIsNoneIsAMissingSampleOfWhatHangsThere) {
  Text text;
  text.rows = "1 2 3 0 0 0 nan 0 0\n0 0 0 nan 0 0 0 0 90\nnan 0 0 0 0 0 0 0 0\n";
  text.frames = "Frames: 3\n";
  const auto& markers = good(text.join()).markers;
  EXPECT_TRUE(markers.present(0, 1));
  EXPECT_FALSE(markers.present(0, 2)) << "the arm is not known";
  EXPECT_TRUE(markers.present(1, 0));
  EXPECT_FALSE(markers.present(1, 1));
  EXPECT_FALSE(markers.present(2, 0));
}

TEST(ReadBvh, ReadsAFile) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a.bvh", Text{}.join(), false));
  EXPECT_EQ(read_bvh(scratch / "a.bvh").value().markers.frames(), 2);
  EXPECT_EQ(read_bvh(scratch / "no.bvh").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
