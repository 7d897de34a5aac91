// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/xdf/internal/stream_header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A header whose channels have these fields, of a stream of this type.
Result<XdfHeader> header(const std::vector<std::string>& channels, const std::string& type = "MoCap",
                         const std::string& count = "", const std::string& format = "float32") {
  std::string xml = "<?xml version=\"1.0\"?><info><name>a</name><type>" + type + "</type><channel_count>";
  xml += count.empty() ? std::to_string(channels.size()) : count;
  xml += "</channel_count><nominal_srate>120</nominal_srate><channel_format>" + format +
         "</channel_format><desc><channels>";
  for (const std::string& channel : channels) xml += "<channel>" + channel + "</channel>";
  return parse_xdf_header(xml + "</channels></desc></info>");
}

std::string typed(const std::string& marker, const std::string& type) {
  return "<marker>" + marker + "</marker><type>" + type + "</type><unit>mm</unit>";
}

std::string labelled(const std::string& label) { return "<label>" + label + "</label>"; }

TEST(StreamHeader, TheAxesOfAMarkerShareAUnit) {
  const auto unit_of = [](const char* x, const char* y, const char* z) {
    const auto axis = [](const char* type, const char* unit) {
      return "<marker>A</marker><type>" + std::string(type) + "</type><unit>" + unit + "</unit>";
    };
    return header({axis("PositionX", x), axis("PositionY", y), axis("PositionZ", z)}).value().markers[0].unit;
  };
  EXPECT_EQ(unit_of("mm", "mm", "mm"), "mm");
  EXPECT_EQ(unit_of("mm", "millimeters", ""), "mm") << "the same, or not said";
  EXPECT_EQ(unit_of("", "m", "m"), "m");
  EXPECT_EQ(unit_of("mm", "m", "m"), "mm and m and m") << "which no reader takes for a length";
  EXPECT_EQ(unit_of("mm", "mm", "furlong"), "mm and furlong");
}

TEST(StreamHeader, CoordinatesMayComeInAnyOrderAmongOthers) {
  const auto found = header({typed("A", "PositionZ"), typed("A", "OrientationX"), typed("B", "PositionX"),
                             typed("A", "positiony"), typed("A", "PositionX"), typed("B", "PositionY")});
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_THAT(found->markers, SizeIs(1)) << "B has no z";
  EXPECT_EQ(found->markers[0].name, "A");
  EXPECT_EQ(found->markers[0].unit, "mm");
  EXPECT_THAT(found->markers[0].channel, ElementsAre(4, 3, 0));
  EXPECT_EQ(found->other_channels, 3U);
  EXPECT_EQ(found->rate_hz, 120.0);
}

TEST(StreamHeader, LabelsCountInStreamsOfMotionAlone) {
  const std::vector<std::string> channels = {labelled("LASI x"), labelled("LASI y"), labelled("LASI z")};
  const auto motion = header(channels), other = header(channels, "EEG");
  ASSERT_TRUE(motion && other);
  ASSERT_THAT(motion->markers, SizeIs(1));
  EXPECT_EQ(motion->markers[0].name, "LASI");
  EXPECT_THAT(other->markers, IsEmpty());
  EXPECT_EQ(other->other_channels, 3U);
}

TEST(StreamHeader, ALabelNeedsANameAndASeparator) {
  for (const char* stem : {"Max", "_", "", "x"}) {
    std::vector<std::string> channels;
    for (const char axis : {'x', 'y', 'z'}) channels.push_back(labelled(std::string(stem) + axis));
    const auto found = header(channels);
    ASSERT_TRUE(found) << stem;
    EXPECT_THAT(found->markers, IsEmpty()) << stem;
  }
}

TEST(StreamHeader, ChannelsBeyondTheirCountAreNotThere) {
  const auto found =
      header({typed("A", "PositionX"), typed("A", "PositionY"), typed("A", "PositionZ")}, "MoCap", "2");
  ASSERT_TRUE(found);
  EXPECT_THAT(found->markers, IsEmpty());
  EXPECT_EQ(found->other_channels, 2U);
}

TEST(StreamHeader, WhatIsNoHeaderIsRefused) {
  EXPECT_FALSE(parse_xdf_header("<info"));
  EXPECT_FALSE(parse_xdf_header(""));
  for (const char* count : {"0", "-1", "nan", "1e9", "many"}) {
    const auto refused = header({}, "MoCap", count);
    ASSERT_FALSE(refused) << count;
    EXPECT_THAT(refused.error().message, HasSubstr("stream 'a' has channel_count"));
  }
  EXPECT_FALSE(header({}, "MoCap", "1", "uint8"));
}

TEST(StreamHeader, FormatsHaveTheirBytes) {
  const std::pair<const char*, std::size_t> sizes[] = {
      {"float32", 4}, {"double64", 8}, {"int8", 1}, {"int16", 2}, {"int32", 4}, {"int64", 8}, {"string", 0}};
  for (const auto& [format, bytes] : sizes) {
    const auto found = header({}, "MoCap", "3", format);
    ASSERT_TRUE(found) << format;
    EXPECT_EQ(size_of(found->format), bytes) << format;
  }
}

}  // namespace
}  // namespace kinemark::io::internal
