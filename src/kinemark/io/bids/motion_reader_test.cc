// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings as other programs write them: the columns of the examples of BIDS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kJson = R"({"TaskName": "walk", "SamplingFrequency": 90, "MissingValues": "-999"})";
constexpr const char* kChannels =
    "name\ttype\tcomponent\ttracked_point\tunits\n"
    "t1\tPOS\tx\thead\tmm\nt2\tPOS\tz\thead\tmm\nt3\tPOS\ty\thead\tmm\n"
    "r1\tORNT\tquat_w\thead\tn/a\nl1\tLATENCY\tn/a\tn/a\ts\n"
    "v1\tVEL\tx\thead\tm/s\nv2\tVEL\ty\thead\tm/s\nv3\tVEL\tz\thead\tm/s\np1\tPOS\tx\tfoot\tm\n";

Result<data::Trial> parse(std::string_view motion, std::string_view channels = kChannels,
                          std::string_view json = kJson) {
  return parse_motion_bids({.motion = motion, .channels = channels, .json = json});
}

std::string message(const Result<data::Trial>& trial) { return trial ? "read" : trial.error().message; }

TEST(MotionReader, ColumnsAreFoundByTheirRowsInAnyOrder) {
  const auto trial =
      parse("1000\t3000\t2000\t1\t0.1\t4\t5\t6\t7\r\n-999\t3000\t2000\t1\t0.2\t4\tn/a\t6\t7\r\n");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("head"));
  EXPECT_EQ(trial->markers.x(0, 0), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(trial->markers.present(1, 0));
  EXPECT_EQ(trial->markers.time.rate_hz, 90.0);
  EXPECT_EQ(trial->units_in_file, "mm");
  EXPECT_THAT(trial->channels.names, ElementsAre("head"));
  EXPECT_EQ(trial->channels.kinds.front(), data::ChannelKind::other);
  EXPECT_EQ(trial->channels.units.front(), "m/s");
  EXPECT_EQ(trial->channels.values[1], 5.0);
  EXPECT_TRUE(std::isnan(trial->channels.values[4]));
  EXPECT_THAT(
      trial->warnings,
      ElementsAre(HasSubstr("r1, foot"), HasSubstr("column l1 puts frame 2 at 0.2 s and the rate at 0.111")));
}

TEST(MotionReader, AMissingValueIsANumberHoweverItIsWritten) {
  const auto trial =
      parse("-999.0\t3000\t2000\t1\t0\t4\t5\t6\t7\r\n-9.99e2\t-998.9\t1\t1\t0.011\t4\t5\t6\t7\r\n");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_FALSE(trial->markers.present(0, 0));
  EXPECT_FALSE(trial->markers.present(1, 0));
  const auto near = parse("1\t-998.9\t2\t1\t0\t4\t5\t6\t7\n");
  EXPECT_TRUE(near->markers.present(0, 0)) << "another number is a measurement";
}

TEST(MotionReader, WhatDoesNotFitIsRefusedWithItsLine) {
  const std::string row = "1\t2\t3\t4\t5\t6\t7\t8\t9\n";
  EXPECT_EQ(message(parse(row)), "read");
  EXPECT_THAT(message(parse(row + "1\t2\n")),
              HasSubstr("motion.tsv: line 2: 2 columns; channels.tsv names 9"));
  EXPECT_THAT(message(parse("1\t2\t3\t4\t5\t6\t7\t8\t9\t10\n")),
              HasSubstr("line 1: more columns; channels.tsv names 9"));
  EXPECT_THAT(message(parse(row + "1\t2\tx\t4\t5\t6\t7\t8\t9\n")),
              HasSubstr("line 2: column 3: 'x'; expected a number or -999"));
  EXPECT_THAT(message(parse(row + "\n" + row)), HasSubstr("line 2: is blank"));
  EXPECT_THAT(message(parse("")), HasSubstr("motion.tsv: holds no row"));
  EXPECT_THAT(message(parse(row, "name\ttype\n")), HasSubstr("channels.tsv: line 1: no column component"));
  EXPECT_THAT(message(parse(row, "name\ttype\tcomponent\ttracked_point\tunits\na\tPOS\n")),
              HasSubstr("line 2: 2 cells under 5 names"));
  EXPECT_THAT(message(parse("1\n", "name\ttype\tcomponent\ttracked_point\tunits\na\tPOS\tx\tp\tm\n")),
              HasSubstr("no tracked point"));
  EXPECT_THAT(message(parse("1\t2\t3\n",
                            "name\ttype\tcomponent\ttracked_"
                            "point\tunits\na\tPOS\tx\tp\tvolt\nb\tPOS\ty\tp\tvolt\nc\tPOS\tz\tp\tvolt\n")),
              HasSubstr("p is in 'volt'; expected a unit of length"));
  EXPECT_THAT(message(parse(row, kChannels, "{}")), HasSubstr("motion.json: SamplingFrequency"));
  EXPECT_THAT(message(parse(row, kChannels, "[1]")), HasSubstr("is no object of JSON"));
}

TEST(MotionReader, APointThatComesTwiceGetsANumber) {
  std::string channels = "name\ttype\tcomponent\ttracked_point\tunits\n";
  for (int i = 0; i < 2; ++i)
    for (const char* axis : {"x", "y", "z"}) channels += std::string("a\tPOS\t") + axis + "\tp\tm\n";
  const auto trial = parse("1\t2\t3\t4\t5\t6\n", channels);
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("p", "p_2"));
  EXPECT_EQ(trial->markers.x(0, 1), Eigen::Vector3d(4.0, 5.0, 6.0));
}

TEST(MotionReader, FilesThatAreNotThereAreNamed) {
  const testing_support::ScratchFolder scratch;
  EXPECT_THAT(message(read_motion_bids(scratch / "a.tsv")), HasSubstr("ends in _motion.tsv"));
  EXPECT_THAT(message(read_motion_bids(scratch / "a_motion.tsv")),
              HasSubstr("has no channels.tsv beside it"));
  ASSERT_TRUE(write_text(scratch / "a_channels.tsv", kChannels, false));
  EXPECT_THAT(message(read_motion_bids(scratch / "a_motion.tsv")), HasSubstr("has no motion.json beside it"));
  ASSERT_TRUE(write_text(scratch / "a_motion.json", kJson, false));
  const auto gone = read_motion_bids(scratch / "a_motion.tsv");
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
