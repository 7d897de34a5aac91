// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/xdf/xdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/xdf/testing/xdf_bytes.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::chunk;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::motion_header;
using testing::raw;
using testing::sample;
using testing::samples;
using ::testing::SizeIs;
using testing::small_file;
using testing::xdf_start;

Result<data::Trial> parse(const std::string& bytes) {
  return parse_xdf(std::as_bytes(std::span(bytes)), "f.xdf");
}
std::string message(const Result<data::Trial>& trial) { return trial ? "read" : trial.error().message; }

TEST(Xdf, PositionsOfAMotionStreamAreMarkers) {
  const auto trial = parse(small_file());
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->warnings, IsEmpty());
  EXPECT_THAT(trial->markers.names, ElementsAre("A"));
  EXPECT_EQ(trial->markers.time, (TimeBase{.rate_hz = 100.0, .t0_s = 0.0, .frames = 5}));
  EXPECT_EQ(trial->format, "XDF");
  for (int f = 0; f < 5; ++f)
    EXPECT_EQ(trial->markers.x(f, 0), Eigen::Vector3d(0.001F * static_cast<float>(f), 0.5, 1.0));
}

template <class T>
Result<data::Trial> of_format(std::string_view format, T x) {
  return parse(xdf_start() + motion_header({"A"}, 100.0, format, "mm") +
               samples({sample<T>(1.0, {x, x, x}), sample<T>(1.01, {x, x, x})}));
}

TEST(Xdf, EveryFormatOfNumbersAndUnitsOfLength) {
  for (const auto& trial : {of_format<float>("float32", 12.0F), of_format<double>("double64", 12.0),
                            of_format<std::int8_t>("int8", 12), of_format<std::int16_t>("int16", 12),
                            of_format<std::int32_t>("int32", 12), of_format<std::int64_t>("int64", 12)}) {
    ASSERT_TRUE(trial) << trial.error().message;
    EXPECT_DOUBLE_EQ(trial->markers.x(1, 0)[2], 0.012);
  }
  EXPECT_THAT(message(parse(xdf_start() + motion_header({"A"}, 100.0, "float32", "volt") +
                            samples({sample<float>(1.0, {1, 2, 3})}))),
              HasSubstr("A is in 'volt'; expected a unit of length"));
  const auto none = parse(xdf_start() + motion_header({"A"}, 100.0, "float32", "") +
                          samples({sample<float>(1.0, {1, 2, 3})}));
  ASSERT_TRUE(none);
  EXPECT_THAT(none->warnings, ElementsAre(HasSubstr("metres are assumed")));
}

TEST(Xdf, FramesThatWereDroppedAreMissing) {
  std::vector<std::string> all;
  for (const int f : {0, 1, 2, 5, 6, 7, 8})
    all.push_back(sample<float>(5.0 + 0.01 * f, {0.1F * static_cast<float>(f), 0, 1}));
  const auto trial = parse(xdf_start() + motion_header({"A"}, 100.0) + samples(all));
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->markers.frames(), 9);
  EXPECT_FALSE(trial->markers.present(3, 0));
  EXPECT_FALSE(trial->markers.present(4, 0));
  EXPECT_FLOAT_EQ(static_cast<float>(trial->markers.x(5, 0)[0]), 0.5F);
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("dropped 2 frames of 9 (longest gap 0.03 s)")));
}

TEST(Xdf, ClockOffsetsAreAddedAndEventsAreOnTheTrialsClock) {
  std::vector<std::string> all;
  for (int f = 0; f < 200; ++f) all.push_back(sample<float>(50.0 + 0.01 * f, {0, 0, 1}));
  const std::string markers =
      chunk(2, raw(std::uint32_t{2}) +
                   "<info><name>cues</name><type>Markers</type><channel_count>1</channel_count>"
                   "<nominal_srate>0</nominal_srate><channel_format>string</channel_format></info>");
  const std::string cue =
      samples({raw(std::uint8_t{8}) + raw(1050.75) + raw(std::uint8_t{1}) + raw(std::uint8_t{2}) + "go"}, 2);
  const auto trial = parse(xdf_start() + motion_header({"A"}, 100.0) + markers + samples(all) +
                           testing::offset(50.0, 1000.25) + cue + testing::offset(51.0, 1000.25) +
                           testing::offset(1050.0, 0.0, 2));
  ASSERT_TRUE(trial) << trial.error().message;
  ASSERT_THAT(trial->events, SizeIs(1));
  EXPECT_EQ(trial->events[0].label, "go");
  EXPECT_NEAR(trial->events[0].time_s, 0.5, 1e-9);
  EXPECT_EQ(trial->markers.time.t0_s, 0.0);
  EXPECT_THAT(trial->warnings, IsEmpty());
}

TEST(Xdf, LabelsNameMarkersWhereTheStreamSaysNothingElse) {
  std::string channels;
  for (const char* label : {"LASI_x", "LASI_y", "LASI_z", "head.X", "head.Y", "head.Z", "xyz", "battery"})
    channels += std::string("<channel><label>") + label + "</label></channel>";
  const auto trial = parse(xdf_start() + motion_header({}, 100.0, "float32", "", channels, 8) +
                           samples({sample<float>(1.0, {1, 2, 3, 4, 5, 6, 7, 8})}));
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("LASI", "head"));
  EXPECT_EQ(trial->markers.x(0, 1), Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(trial->warnings, ::testing::Contains(HasSubstr("2 channels of no position left out")));
}

TEST(Xdf, AMarkerThatComesTwiceGetsANumber) {
  const auto trial = parse(xdf_start() + motion_header({"A", "A"}, 100.0) +
                           samples({sample<float>(1.0, {1, 2, 3, 4, 5, 6})}));
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("A", "A_2"));
  EXPECT_EQ(trial->markers.x(0, 1), Eigen::Vector3d(4, 5, 6));
}

TEST(Xdf, WhatIsNotAsTheFormatHasItIsRefusedWithItsPlace) {
  EXPECT_THAT(message(parse("XDG:")), HasSubstr("f.xdf: does not begin with XDF:"));
  EXPECT_THAT(message(parse(xdf_start())), HasSubstr("its streams: none"));
  EXPECT_THAT(message(parse(xdf_start() + std::string("\x07\x01", 2))),
              HasSubstr("a chunk begins with 7; expected 1, 4 or 8"));
  EXPECT_THAT(message(parse(xdf_start() + samples({}, 9))),
              HasSubstr("a chunk of stream 9, which has no header before it"));
  EXPECT_THAT(message(parse(xdf_start() + motion_header({"A"}, 100.0) + motion_header({"A"}, 100.0))),
              HasSubstr("stream 1 has a second header"));
  EXPECT_THAT(
      message(parse(xdf_start() + motion_header({"A"}, 100.0) + samples({sample<float>(1.0, {1, 2})}))),
      HasSubstr("samples of stream 'OptiTrack' do not fill their chunk"));
  EXPECT_THAT(message(parse(xdf_start() + motion_header({"A"}, 100.0, "float16"))),
              HasSubstr("channel_format 'float16', which is none of XDF"));
  EXPECT_THAT(message(parse(xdf_start() + motion_header({}, 100.0))),
              HasSubstr("channel_count '0'; expected 1 to 1000000"));
}

TEST(Xdf, AFileThatEndsInAChunkIsReadUpToThere) {
  const std::string whole = small_file();
  const auto trial = parse(whole + chunk(3, "lost samples").substr(0, 9));
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->markers.frames(), 5);
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("ends in the middle of a chunk")));
}

TEST(Xdf, IsReadFromADisk) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "f.xdf", small_file(), false));
  EXPECT_TRUE(read_xdf(scratch / "f.xdf"));
  EXPECT_EQ(read_xdf(scratch / "none.xdf").error().code, Code::io);
  EXPECT_TRUE(is_xdf(small_file()));
}

}  // namespace
}  // namespace kinemark::io
