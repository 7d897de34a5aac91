// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/orientation_csv.h"

#include <gmock/gmock.h>

#include <string>

#include "kinemark/io/text/orientation_table.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kMotiveKeys =
    "Format Version,1.23,Take Name,swing,Capture Frame Rate,100.000000,Export Frame Rate,100.000000,Total "
    "Exported Frames,3,Rotation Type,Quaternion,Length Units,Meters\n\n";
/// A stick with a marker beside it, and a bone; the stick is not seen in the second frame.
const std::string kMotive = kMotiveKeys +
                            ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
                            "Body,Rigid Body,Marker,Marker,Marker,Bone,Bone,Bone,Bone\n"
                            ",Name,stick,stick,stick,stick,stick,stick,stick,stick,stick:M1,stick:M1,stick:"
                            "M1,Ann:Hip,Ann:Hip,Ann:Hip,Ann:Hip\n"
                            ",ID,1,1,1,1,1,1,1,1,2,2,2,3,3,3,3\n"
                            ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker "
                            "Error,Position,Position,Position,Rotation,Rotation,Rotation,Rotation\n"
                            "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z,X,Y,Z,W\n"
                            "0,0.000000,0,0,0.6,0.8,1,2,3,0.001,1,2,3,1,0,0,0\n"
                            "1,0.010000,,,,,,,,,1,2,3,0,1,0,0\n"
                            "2,0.020000,0,0,-0.6,-0.8,1,2,3,0.001,1,2,3,0,0,0,-1\n";

std::string with(std::string text, const std::string& old, const std::string& by) {
  text.replace(text.find(old), old.size(), by);
  return text;
}

std::string message(const std::string& text) {
  const auto read = parse_orientation_csv(text, "o.csv");
  EXPECT_FALSE(read);
  return read ? "" : read.error().message;
}

TEST(OrientationCsv, RigidBodiesAndBonesOfMotive) {
  EXPECT_TRUE(begins_orientation_csv(kMotive));
  EXPECT_TRUE(begins_orientation_csv("\xEF\xBB\xBF" + kMotive));
  const auto read = parse_orientation_csv(kMotive, "o.csv").value();
  EXPECT_THAT(read.names, ElementsAre("stick", "Ann:Hip"));
  EXPECT_EQ(read.time.rate_hz, 100.0);
  ASSERT_EQ(read.frames(), 3);
  EXPECT_FALSE(read.present(1, 0));
  EXPECT_TRUE(read.present(1, 1));
  EXPECT_EQ(read.quaternion[0], 0.8) << "w is the last in Motive";
  EXPECT_EQ(read.quaternion[3], 0.6);
  EXPECT_TRUE(read.rotation(0, 0).isApprox(read.rotation(2, 0))) << "a change of sign is no turn";
  EXPECT_TRUE((read.rotation(0, 1) * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(OrientationCsv, WithoutTimesMotiveCountsFrames) {
  std::string text = kMotive;
  for (const char* time : {",Time (Seconds)", ",0.000000", ",0.010000", ",0.020000"})
    text = with(text, time, "");
  for (const char* blank : {",Type", ",Name", ",ID", ",,Rotation"}) text = with(text, blank, blank + 1);
  const auto read = parse_orientation_csv(text, "o.csv").value();
  EXPECT_EQ(read.time.rate_hz, 100.0);
  EXPECT_THAT(read.names, ElementsAre("stick", "Ann:Hip"));
  EXPECT_EQ(read.frames(), 3);
}

TEST(OrientationCsv, SaysWhatIsWrongInMotive) {
  EXPECT_THAT(message(with(kMotive, ",W,X,Y,Z,,", ",,X,Y,Z,,")), HasSubstr("export them as quaternions"));
  std::string markers = kMotive;
  while (markers.find("Rigid Body") != std::string::npos) markers = with(markers, "Rigid Body", "Other");
  while (markers.find(",Bone") != std::string::npos) markers = with(markers, ",Bone", ",Thing");
  EXPECT_FALSE(begins_orientation_csv(markers));
  EXPECT_THAT(message(markers), HasSubstr("no column is the rotation of a rigid body or a bone"));
  EXPECT_THAT(message(with(kMotive, "0,0,0.6,0.8", "0,0,0.6,1.8")),
              HasSubstr("line 8, 'stick': a quaternion of length"));
  EXPECT_THAT(message(with(kMotive, "0,0,0.6,0.8", "0,zero,0.6,0.8")),
              HasSubstr("line 8, column 4: 'zero' is no number"));
  EXPECT_THAT(message(with(kMotive, ",0,0,0,-1\n", "\n")),
              HasSubstr("line 10: 13 cells; expected 17 or more"));
  EXPECT_THAT(message(with(kMotive, "1,0.010000", "1,later")), HasSubstr("the time is 'later'"));
}

TEST(OrientationCsv, TablesOfQuaternions) {
  const std::string text =
      "time,a_w,a_x,a_y,a_z,b_w,b_x,b_y,b_z\n0,1,0,0,0,,,,\n0.02,0,1,0,0,0,0,0,0\n0.04,0,0,-1,0,0.6,0,0.8,"
      "0\n";
  EXPECT_TRUE(begins_orientation_csv(text));
  const auto read = parse_orientation_csv(text, "o.csv").value();
  EXPECT_THAT(read.names, ElementsAre("a", "b"));
  EXPECT_EQ(read.time.rate_hz, 50.0);
  EXPECT_FALSE(read.present(0, 1));
  EXPECT_FALSE(read.present(1, 1));
  EXPECT_TRUE(read.present(2, 1));
  EXPECT_THAT(read.warnings, ElementsAre("sensor 'b': quaternions of zeros in 1 rows, taken as missing"));
  EXPECT_THAT(parse_orientation_csv(with(text, "time,", "who,time,"), "o.csv").error().message,
              HasSubstr("expected 10 or more"));
  EXPECT_FALSE(begins_orientation_csv("time,a_w,a_x,a_y\n0,1,0,0\n")) << "three of four";
  EXPECT_FALSE(begins_orientation_csv("time,LASI_x,LASI_y,LASI_z\n0,1,0,0\n")) << "positions";
  EXPECT_FALSE(begins_orientation_csv(""));
  EXPECT_THAT(message("time,a,b\n0,1,2\n"), HasSubstr("line 1: expected the labels time, then NAME_w"));
  EXPECT_THAT(message("time,a_w,a_x,a_y,a_z\n"), HasSubstr("holds no orientation"));
}

TEST(OrientationCsv, WhatIsWrittenReadsBackToTheBit) {
  const testing_support::ScratchFolder scratch;
  const auto one = parse_orientation_csv(kMotive, "o.csv").value();
  for (const char* name : {"o.csv", "o.sto"}) {
    ASSERT_TRUE(write_orientations(scratch / name, one));
    const auto back = std::string(name) == "o.csv" ? read_orientation_csv(scratch / name)
                                                   : read_orientations(scratch / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->names, one.names);
    EXPECT_EQ(back->time.rate_hz, one.time.rate_hz);
    ASSERT_EQ(back->quaternion.size(), one.quaternion.size());
    for (std::int64_t f = 0; f < 3; ++f)
      for (std::int64_t s = 0; s < 2; ++s) {
        ASSERT_EQ(back->present(f, s), one.present(f, s));
        for (std::size_t k = 0; k < 4 && one.present(f, s); ++k) {
          const auto i = 4 * static_cast<std::size_t>(2 * f + s) + k;
          EXPECT_EQ(back->quaternion[i], one.quaternion[i]);
        }
      }
    EXPECT_EQ(write_orientations(scratch / name, one).error().code, Code::io) << "it is there";
    EXPECT_TRUE(write_orientations(scratch / name, one, true));
  }
  EXPECT_EQ(write_orientations(scratch / "o.trc", one).error().code, Code::usage);
  auto odd = one;
  odd.names[0] = "a,b";
  EXPECT_THAT(write_orientations(scratch / "p.csv", odd).error().message,
              HasSubstr("'a,b' holds a tab, comma"));
}

}  // namespace
}  // namespace kinemark::io
