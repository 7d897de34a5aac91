// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/c3d/header.h"

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

C3dParameters sample() {
  C3dParameters p;
  C3dGroup& point = p.group("point");
  point.description = "markers";
  point.parameters.push_back(
      {.name = "USED", .type = C3dType::int16, .numbers = {40000}, .description = "how many"});
  point.parameters.push_back(
      {.name = "LABELS", .type = C3dType::text, .dims = {4, 2}, .texts = {"LASI", "C7"}, .locked = true});
  point.parameters.push_back({.name = "LABELS2", .type = C3dType::text, .dims = {6, 1}, .texts = {"Vä"}});
  C3dGroup& other = p.group("OTHER");
  other.parameters.push_back(
      {.name = "MATRIX", .type = C3dType::float32, .dims = {2, 3}, .numbers = {1, 2, 3, 4, 5, -6.5}});
  other.parameters.push_back({.name = "FLAGS", .type = C3dType::byte, .dims = {3}, .numbers = {0, 1, 255}});
  other.parameters.push_back({.name = "NONE", .type = C3dType::float32, .dims = {0}});
  return p;
}

TEST(C3dParameters, SurviveARoundTripOnEachProcessor) {
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    const auto bytes = encode_parameters(sample(), processor).value();
    EXPECT_EQ(bytes.size() % kC3dBlock, 0U);
    EXPECT_EQ(std::to_integer<int>(bytes[3]), static_cast<int>(processor));
    std::vector<std::string> warnings;
    const C3dParameters p = parse_parameters(bytes, processor, warnings);
    EXPECT_THAT(warnings, ElementsAre());
    ASSERT_EQ(p.groups.size(), 2U);
    EXPECT_EQ(p.groups[0].name, "POINT");
    EXPECT_EQ(p.groups[0].description, "markers");
    EXPECT_EQ(p.find("point", "used")->description, "how many");
    EXPECT_EQ(p.number("POINT", "USED"), 40000.0 - 65536.0)
        << "16 bits are signed until somebody knows better";
    EXPECT_TRUE(p.find("POINT", "LABELS")->locked);
    EXPECT_FALSE(p.find("POINT", "USED")->locked);
    EXPECT_THAT(p.texts("POINT", "LABELS"), ElementsAre("LASI", "C7", "Vä"));
    EXPECT_THAT(p.numbers("OTHER", "MATRIX"), ElementsAre(1, 2, 3, 4, 5, -6.5));
    EXPECT_THAT(p.find("OTHER", "MATRIX")->dims, ElementsAre(2, 3));
    EXPECT_THAT(p.numbers("OTHER", "FLAGS"), ElementsAre(0, 1, 255));
    EXPECT_FALSE(p.number("OTHER", "NONE"));
    EXPECT_EQ(p.find("OTHER", "ABSENT"), nullptr);
    EXPECT_FALSE(p.has_group("ABSENT"));
  }
}

TEST(C3dParameters, MayStandBeforeTheirGroupOrBelongToNone) {
  std::vector<std::byte> bytes = encode_parameters(sample(), Processor::intel).value();
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const std::size_t group = std::string_view(text, bytes.size()).find("OTHER");
  bytes[group - 1] = std::byte{0xF0};  // id -16: nobody's
  std::vector<std::string> warnings;
  const C3dParameters p = parse_parameters(bytes, Processor::intel, warnings);
  EXPECT_TRUE(p.has_group("OTHER"));
  EXPECT_EQ(p.numbers("GROUP 2", "FLAGS").size(), 3U);
}

TEST(C3dParameters, OneCutShortKeepsWhatIsThere) {
  std::vector<std::byte> bytes = encode_parameters(sample(), Processor::intel).value();
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const std::size_t labels = std::string_view(text, bytes.size()).find("LABELS");
  bytes[labels + 10] = std::byte{200};  // 4 x 200 letters promised
  std::vector<std::string> warnings;
  const C3dParameters p = parse_parameters(bytes, Processor::intel, warnings);
  EXPECT_THAT(warnings, Contains(HasSubstr("POINT:LABELS is cut short")));
  EXPECT_EQ(p.texts("POINT", "LABELS")[0], "LASIC7") << "all eight letters as one of the promised 200";
  EXPECT_EQ(p.numbers("OTHER", "FLAGS").size(), 3U) << "the next entries are found by their pointers";
}

TEST(C3dParameters, ASectionThatEndsEarlyIsReported) {
  const std::vector<std::byte> bytes = encode_parameters(sample(), Processor::intel).value();
  for (std::size_t n = 4; n < 150; ++n) {
    std::vector<std::string> warnings;
    const C3dParameters p = parse_parameters(std::span(bytes).first(n), Processor::intel, warnings);
    EXPECT_LE(p.groups.size(), 2U);
  }
  std::vector<std::string> warnings;
  static_cast<void>(parse_parameters(std::span(bytes).first(60), Processor::intel, warnings));
  EXPECT_THAT(warnings, Contains(HasSubstr("parameter section is corrupt")));
}

TEST(C3dParameters, TextIsMadeFitToShow) {
  EXPECT_EQ(clean_text(" LASI  "), "LASI");
  EXPECT_EQ(clean_text(std::string_view("a\0b\0\0", 5)), "a b");
  EXPECT_EQ(clean_text("caf\xE9"), "café") << "Latin-1";
  EXPECT_EQ(clean_text("café"), "café") << "UTF-8";
  EXPECT_EQ(clean_text("\xC0\xBF"), "À¿") << "an overlong form is no UTF-8";
}

TEST(C3dHeader, EventsSurviveARoundTrip) {
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    C3dHeader h{.points = 7,
                .analog_per_frame = 12,
                .first_frame = 3,
                .last_frame = 65535,
                .scale = -0.25F,
                .data_block = 9,
                .samples_per_frame = 4,
                .rate_hz = 120.5F};
    for (int i = 0; i < 20; ++i) h.events.push_back({.label = "RIC", .time_s = 0.5 * i, .shown = i % 2 == 0});
    const C3dHeader back = parse_header(encode_header(h, processor), processor);
    EXPECT_EQ(back.points, 7);
    EXPECT_EQ(back.last_frame, 65535);
    EXPECT_EQ(back.scale, -0.25F);
    EXPECT_EQ(back.rate_hz, 120.5F);
    ASSERT_EQ(back.events.size(), 18U) << "the format's limit";
    EXPECT_EQ(back.events[17].label, "RIC");
    EXPECT_EQ(back.events[17].time_s, 8.5);
    EXPECT_FALSE(back.events[17].shown);
  }
}

}  // namespace
}  // namespace kinemark::io
