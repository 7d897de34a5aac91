// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/amc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A root, a thigh 18 units down, a shank 17 further whose axes are turned by 20 deg about z, a hip joint
/// that does not move.
const std::string kAsf =
    "# by hand\n:version 1.10\n:name test\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n:documentation\n  "
    " begin with anything\n"
    ":root\n   order TX TY TZ RX RY RZ\n   axis XYZ\n   position 0 0 0\n   orientation 0 0 0\n"
    ":bonedata\n"
    "  begin\n     id 1\n     name hip\n     direction 1 0 0\n     length 2\n     axis 0 0 0 XYZ\n  end\n"
    "  begin\n     id 2\n     name thigh\n     direction 0 -1 0\n     length 18\n     axis 0 0 0 XYZ\n    "
    "dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n           (-60.0 70.0)\n  end\n"
    "  begin\n     id 3\n     name shank\n     direction 0 -1 0\n     length 17\n     axis 0 0 20 XYZ\n    "
    "dof rx\n  end\n"
    ":hierarchy\n  begin\n    root hip\n    hip thigh\n    thigh shank\n  end\n";
const std::string kAmc =
    "#!OML:ASF x.ASF\n:FULLY-SPECIFIED\n:DEGREES\n5\nroot 1 30 2 0 0 0\nthigh 0 0 0\nshank 0\n6\nroot 1 30 2 "
    "0 0 90\nthigh 10 20 30\nshank 40\n";
constexpr double kUnit_m = 0.0254 / 0.45;

data::Trial good(const std::string& amc, std::optional<std::string_view> asf) {
  const auto trial = parse_amc(amc, "t.amc", asf, "t.asf", 120.0);
  EXPECT_TRUE(trial) << trial.error().message;
  if (!trial) return {};
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  return *trial;
}

TEST(ParseAmc, TheRootAndTheEndsOfBonesArePoints) {
  const auto trial = good(kAmc, kAsf);
  EXPECT_THAT(trial.markers.names, ElementsAre("root", "hip_end", "thigh_end", "shank_end"));
  EXPECT_EQ(trial.format, "AMC");
  EXPECT_EQ(trial.first_frame, 5);
  EXPECT_EQ(trial.markers.time.rate_hz, 120.0);
  EXPECT_LT((trial.markers.x(0, 3) - kUnit_m * Vector3d(3, 30 - 35, 2)).norm(), 1e-12)
      << "at rest bones lie along their directions";
}

TEST(ParseAmc, BonesTurnAboutAxesOfTheirOwnThatStay) {
  const auto trial = good(kAmc, kAsf);
  const auto turned = [](double degrees, const Vector3d& axis) {
    return AngleAxisd(degrees * kRadPerDeg, axis).toRotationMatrix();
  };
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Eigen::Matrix3d root = turned(90, z), thigh = root * turned(30, z) * turned(20, y) * turned(10, x);
  const Eigen::Matrix3d shank = thigh * turned(20, z) * turned(40, x) * turned(-20, z);
  Vector3d expected = Vector3d(1, 30, 2) + root * Vector3d(2, 0, 0);
  EXPECT_LT((trial.markers.x(1, 1) - kUnit_m * expected).norm(), 1e-12);
  expected += thigh * Vector3d(0, -18, 0);
  EXPECT_LT((trial.markers.x(1, 2) - kUnit_m * expected).norm(), 1e-12);
  expected += shank * Vector3d(0, -17, 0);
  EXPECT_LT((trial.markers.x(1, 3) - kUnit_m * expected).norm(), 1e-12);
}

TEST(ParseAmc, AnglesAreChannelsInDegrees) {
  const auto trial = good(kAmc, kAsf);
  EXPECT_THAT(trial.channels.names, ElementsAre("root_angles_XYZ", "thigh_angles_XYZ", "shank_angles_X"));
  EXPECT_EQ(trial.channels.values[9 + 3], 10.0);
  EXPECT_EQ(trial.channels.values[9 + 6], 40.0);
  EXPECT_TRUE(std::isnan(trial.channels.values[9 + 7]));
  std::string radians = kAmc;
  radians.replace(radians.find(":DEGREES"), 8, ":RADIANS");
  EXPECT_NEAR(good(radians, kAsf).channels.values[9 + 6], 40.0 * kDegPerRad, 1e-9);
}

TEST(ParseAmc, TheUnitIsTheOneThatMakesAPerson) {
  const auto thigh_m = [](const std::string& length, const std::string& bone) {
    std::string asf = kAsf;
    asf.replace(asf.find("length 0.45"), 11, "length " + length);
    asf.replace(asf.find("length 18"), 9, "length " + bone);
    const auto trial = good(kAmc, asf);
    EXPECT_THAT(trial.warnings.at(0), HasSubstr("length " + length + " of the skeleton names no unit"));
    return (trial.markers.x(0, 2) - trial.markers.x(0, 1)).norm();
  };
  EXPECT_NEAR(thigh_m("0.45", "18"), 18 * kUnit_m, 1e-12);
  EXPECT_NEAR(thigh_m("1", "150"), 1.5, 1e-12) << "centimetres";
  EXPECT_NEAR(thigh_m("1", "1500"), 1.5, 1e-12) << "millimetres";
  EXPECT_NEAR(thigh_m("2.54", "50"), 50 * 0.0254, 1e-12) << "a centimetre times the length";
}

TEST(ParseAmc, ABoneThatAFrameLeavesOutIsMissingWithWhatHangsFromIt) {
  const auto trial = good(kAmc + "8\nroot 0 0 0 0 0 0\nshank 3\n", kAsf);
  EXPECT_TRUE(trial.markers.present(2, 1));
  EXPECT_FALSE(trial.markers.present(2, 2));
  EXPECT_FALSE(trial.markers.present(2, 3));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("jump 1 time")));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 frame leaves bones out")));
}

TEST(ParseAmc, WithoutASkeletonThereAreAnglesAndNoPoints) {
  const auto trial = good(kAmc, std::nullopt);
  EXPECT_THAT(trial.markers.names, IsEmpty());
  EXPECT_EQ(trial.markers.frames(), 2);
  EXPECT_THAT(trial.channels.names,
              ElementsAre("root_position_XYZ", "root_angles_XYZ", "thigh_angles_XYZ", "shank_angles_X"));
  EXPECT_THAT(trial.channels.units, ElementsAre("", "deg", "deg", "deg"));
  EXPECT_EQ(trial.channels.values[12 + 1], 30.0);
  EXPECT_EQ(trial.channels.values[12 + 5], 90.0);
  EXPECT_THAT(trial.warnings.at(0), HasSubstr("it holds angles, but no points"));
}

TEST(SkeletonBeside, IsTheFileOfThatNameElseOfTheSubjectElseTheOnlyOne) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(skeleton_beside(scratch / "02_05.amc").empty());
  EXPECT_TRUE(skeleton_beside("no/such/folder/a.amc").empty());
  const auto put = [&](const char* name) { ASSERT_TRUE(write_text(scratch / name, kAsf, true)); };
  put("other.ASF");
  EXPECT_EQ(skeleton_beside(scratch / "02_05.amc").filename(), "other.ASF");
  put("02.asf");
  EXPECT_EQ(skeleton_beside(scratch / "02_05.amc").filename(), "02.asf");
  put("02_05.asf");
  EXPECT_EQ(skeleton_beside(scratch / "02_05.amc").filename(), "02_05.asf");
  EXPECT_TRUE(skeleton_beside(scratch / "walk.amc").empty()) << "one of three would be a guess";
}

TEST(ReadAmc, FindsTheSkeletonOrTakesTheOneGiven) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a.amc", kAmc, false));
  EXPECT_EQ(read_amc(scratch / "a.amc", {.rate_hz = 120.0}).value().markers.markers(), 0);
  ASSERT_TRUE(write_text(scratch / "a.asf", kAsf, false));
  const auto found = read_amc(scratch / "a.amc", {.rate_hz = 120.0}).value();
  EXPECT_EQ(found.markers.markers(), 4);
  EXPECT_THAT(found.warnings.at(0), HasSubstr("its skeleton is a.asf, which is beside it"));
  EXPECT_EQ(read_amc(scratch / "a.amc", {.rate_hz = 120.0, .skeleton = scratch / "no.asf"}).error().code,
            Code::io);
  EXPECT_EQ(read_amc(scratch / "a.amc", {.rate_hz = 60.0, .skeleton = scratch / "a.asf"})
                .value()
                .markers.time.rate_hz,
            60.0);
  const auto no_rate = read_amc(scratch / "a.amc", {});
  EXPECT_EQ(no_rate.error().code, Code::usage);
  EXPECT_THAT(no_rate.error().message, HasSubstr("--rate"));
}

TEST(ReadAmc, ReadsCmusOwnFiles) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto trial = read_amc(data / "cmu-mocap/02_05.amc", {.rate_hz = 120.0}).value();
  EXPECT_EQ(trial.markers.frames(), 1854);
  EXPECT_EQ(trial.markers.markers(), 31);
  EXPECT_EQ(trial.markers.count_missing(), 0);
  EXPECT_LT((trial.markers.x(0, 0) - kUnit_m * Vector3d(9.62745, 17.7973, -1.03923)).norm(), 1e-12);
}

}  // namespace
}  // namespace kinemark::io
