// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Who is believed when header, parameters and size of a C3D file disagree.
#include "kinemark/io/c3d/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void set(C3dParameters& p, std::string_view group, std::string name, std::vector<double> numbers) {
  auto& list = p.group(group).parameters;
  std::erase_if(list, [&](const C3dParameter& q) { return q.name == name; });
  list.push_back({.name = std::move(name), .type = C3dType::float32, .numbers = std::move(numbers)});
}
void set_text(C3dParameters& p, std::string_view group, std::string name, std::string text) {
  auto& list = p.group(group).parameters;
  std::erase_if(list, [&](const C3dParameter& q) { return q.name == name; });
  list.push_back({.name = std::move(name), .type = C3dType::text, .texts = {std::move(text)}});
}

/// 10 points and 4 analog channels of 5 samples, 100 float frames at 200 Hz from block 4 on: all agree.
struct Claims {
  C3dHeader header{.points = 10,
                   .analog_per_frame = 20,
                   .first_frame = 1,
                   .last_frame = 100,
                   .scale = -0.1F,
                   .data_block = 4,
                   .samples_per_frame = 5,
                   .rate_hz = 200.0F};
  C3dParameters parameters;
  std::size_t frame_bytes = 4 * (40 + 20);
  std::size_t file_bytes = 3 * kC3dBlock + 100 * frame_bytes;

  Claims() {
    set(parameters, "POINT", "USED", {10});
    set(parameters, "POINT", "FRAMES", {100});
    set(parameters, "POINT", "SCALE", {-0.1});
    set(parameters, "POINT", "RATE", {200});
    set(parameters, "POINT", "DATA_START", {4});
    set_text(parameters, "POINT", "UNITS", "mm");
    set(parameters, "ANALOG", "USED", {4});
    set(parameters, "ANALOG", "RATE", {1000});
    set(parameters, "ANALOG", "SCALE", {1, 2, 3, 4});
    set(parameters, "ANALOG", "OFFSET", {0, 0, 0, 0});
  }
  Result<C3dLayout> settle() {
    warnings.clear();
    return settle_layout(header, parameters, Processor::intel, file_bytes, warnings);
  }
  std::string refusal() {
    const auto layout = settle();
    EXPECT_FALSE(layout);
    return layout ? "" : layout.error().message;
  }
  std::vector<std::string> warnings;
};

TEST(C3dLayout, WhereAllAgreeNothingIsSaid) {
  Claims c;
  const auto l = c.settle().value();
  EXPECT_THAT(c.warnings, IsEmpty());
  EXPECT_EQ(l.points, 10);
  EXPECT_EQ(l.analog_channels, 4);
  EXPECT_EQ(l.samples_per_frame, 5);
  EXPECT_EQ(l.frames, 100);
  EXPECT_EQ(l.rate_hz, 200.0);
  EXPECT_TRUE(l.is_float);
  EXPECT_DOUBLE_EQ(l.scale, 0.1);
  EXPECT_EQ(l.data_offset, 3 * kC3dBlock);
  EXPECT_EQ(l.frame_bytes, c.frame_bytes);
  EXPECT_DOUBLE_EQ(l.metres_per_unit, 1e-3);
  EXPECT_THAT(l.analog_scale, ElementsAre(1, 2, 3, 4));
}

TEST(C3dLayout, FramesLieWithinTheFileWhateverIsClaimed) {
  for (const double stated : {0.0, 1.0, 99.0, 100.0, 101.0, 65535.0, -1.0, 1e9})
    for (const int last : {0, 1, 50, 100, 65535})
      for (const std::size_t frames : {std::size_t{1}, std::size_t{64}, std::size_t{100}, std::size_t{250}}) {
        Claims c;
        c.header.last_frame = last;
        set(c.parameters, "POINT", "FRAMES", {stated});
        c.file_bytes = 3 * kC3dBlock + frames * c.frame_bytes;
        const auto l = c.settle();
        ASSERT_TRUE(l) << l.error().message;
        EXPECT_GT(l->frames, 0);
        EXPECT_LE(l->data_offset + static_cast<std::size_t>(l->frames) * l->frame_bytes, c.file_bytes)
            << stated << " " << last << " " << frames;
        // 0 is no statement, -1 is 65535 in sixteen bits.
        const double meant = stated == -1.0 ? 65535.0 : stated;
        if (meant != 0.0 && last != 0 && meant != last) {
          EXPECT_FALSE(c.warnings.empty()) << stated << " " << last << " " << frames;
        }
      }
}

TEST(C3dLayout, TheClaimThatFillsTheFileWins) {
  Claims c;
  set(c.parameters, "POINT", "FRAMES", {40});
  EXPECT_EQ(c.settle()->frames, 100) << "the header's";
  EXPECT_THAT(c.warnings, Contains(HasSubstr("POINT:FRAMES states 40 frames, the header 100")));
  c.header.last_frame = 40;
  set(c.parameters, "POINT", "FRAMES", {100});
  EXPECT_EQ(c.settle()->frames, 100) << "the parameter's";
  set(c.parameters, "POINT", "FRAMES", {40});
  EXPECT_EQ(c.settle()->frames, 40) << "nobody's: what is stated is read";
  EXPECT_THAT(c.warnings, Contains(HasSubstr("more bytes after the 40 frames")));
}

TEST(C3dLayout, FieldsCountToThirtyTwoBits) {
  Claims c;
  c.file_bytes = 3 * kC3dBlock + 70'000 * c.frame_bytes;
  c.header.last_frame = 65535;
  set(c.parameters, "POINT", "FRAMES", {-1});  // 65535 as a signed word
  EXPECT_EQ(c.settle()->frames, 70'000) << "by the size of the file";
  set(c.parameters, "TRIAL", "ACTUAL_START_FIELD", {11, 0});
  set(c.parameters, "TRIAL", "ACTUAL_END_FIELD", {70'010 - 65536, 1});
  const auto l = c.settle().value();
  EXPECT_EQ(l.frames, 70'000);
  EXPECT_EQ(l.first_frame, 11);
}

TEST(C3dLayout, DataBeginWhereTheFileCanBeFilledFrom) {
  Claims c;
  c.file_bytes += 2 * kC3dBlock;
  set(c.parameters, "POINT", "DATA_START", {6});
  EXPECT_EQ(c.settle()->data_offset, 5 * kC3dBlock) << "only from there the file is full";
  c.header.data_block = 6;
  set(c.parameters, "POINT", "DATA_START", {4});
  EXPECT_EQ(c.settle()->data_offset, 5 * kC3dBlock);
  EXPECT_THAT(c.warnings, Contains(HasSubstr("the header's is used")));
  set(c.parameters, "POINT", "DATA_START", {60000});
  EXPECT_EQ(c.settle()->data_offset, 5 * kC3dBlock) << "outside the file";
  c.header.data_block = 1;
  EXPECT_THAT(c.refusal(), HasSubstr("points to its data at block 60000"));
}

TEST(C3dLayout, TheSignOfTheScaleTellsFloatFromInteger) {
  Claims c;
  c.frame_bytes /= 2;
  c.file_bytes = 3 * kC3dBlock + 100 * c.frame_bytes;
  c.header.scale = 0.05F;
  set(c.parameters, "POINT", "SCALE", {0.05});
  const auto l = c.settle().value();
  EXPECT_FALSE(l.is_float);
  EXPECT_EQ(l.frame_bytes, c.frame_bytes);
  EXPECT_THAT(c.warnings, IsEmpty());
  set(c.parameters, "POINT", "SCALE", {0.1});
  EXPECT_FLOAT_EQ(static_cast<float>(c.settle()->scale), 0.05F) << "integers are scaled as their header says";
  EXPECT_EQ(c.warnings.size(), 1U);
  set(c.parameters, "POINT", "SCALE", {0.0});
  EXPECT_FLOAT_EQ(static_cast<float>(c.settle()->scale), 0.05F);
  c.header.scale = 0.0F;
  EXPECT_THAT(c.refusal(), HasSubstr("POINT:SCALE is 0; need < 0 (float points) or > 0 (integer points)"));
}

TEST(C3dLayout, UnitsAndAnalogNumbersThatAreMissingAreSaid) {
  Claims c;
  set_text(c.parameters, "POINT", "UNITS", "cm");
  EXPECT_DOUBLE_EQ(c.settle()->metres_per_unit, 1e-2);
  set_text(c.parameters, "POINT", "UNITS", "bananas");
  EXPECT_DOUBLE_EQ(c.settle()->metres_per_unit, 1e-3);
  EXPECT_THAT(c.warnings, Contains(HasSubstr("'bananas', not a known length; mm is assumed")));
  set(c.parameters, "ANALOG", "SCALE", {7, 8});
  EXPECT_THAT(c.settle()->analog_scale, ElementsAre(7, 8, 1, 1));
  EXPECT_THAT(c.warnings, Contains(HasSubstr("ANALOG:SCALE has 2 values for 4 channels")));
}

TEST(C3dLayout, WithoutARateOrAFrameThereIsNothingToRead) {
  Claims c;
  c.header.rate_hz = 0.0F;
  c.parameters.group("POINT").parameters.clear();
  set(c.parameters, "POINT", "SCALE", {-0.1});
  EXPECT_THAT(c.refusal(), HasSubstr("has no frame rate"));
  Claims cut;
  cut.file_bytes = 3 * kC3dBlock + cut.frame_bytes - 1;
  EXPECT_THAT(cut.refusal(), HasSubstr("a frame takes 240 bytes, 239 are there"));
}

}  // namespace
}  // namespace kinemark::io
