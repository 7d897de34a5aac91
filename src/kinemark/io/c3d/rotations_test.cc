// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/rotations.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "kinemark/io/c3d/header.h"
#include "kinemark/io/c3d/number_format.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A file of two segments in two frames at 50 Hz: the second turns by 90 deg about z, and is not seen at the
/// end.
struct RotationFile {
  double ratio = 1.0, used = 2.0, start = 4.0;
  float stretch = 1.0F;  // of a column
  std::size_t cut = 0;   // bytes that are missing at the end
  bool has_group = true;
  Processor processor = Processor::intel;
  int first = 1;  // number of the first frame

  [[nodiscard]] std::vector<std::byte> bytes() const {
    C3dParameters parameters;
    const auto number = [&](const char* group, const char* name, double value,
                            C3dType type = C3dType::int16) {
      parameters.group(group).parameters.push_back(
          {.name = name, .type = type, .dims = {}, .numbers = {value}});
    };
    number("POINT", "USED", 0);
    number("POINT", "FRAMES", 2);
    number("POINT", "SCALE", -1, C3dType::float32);
    number("POINT", "RATE", 50, C3dType::float32);
    number("POINT", "DATA_START", 4);
    if (has_group) {
      parameters.group("ROTATION")
          .parameters.push_back(
              {.name = "LABELS", .type = C3dType::text, .dims = {12, 2}, .texts = {"pelvis_4X4", "thigh"}});
      number("ROTATION", "USED", used);
      number("ROTATION", "RATIO", ratio);
      number("ROTATION", "DATA_START", start);
    }
    auto section = encode_parameters(parameters, processor).value();
    section.resize(2 * kC3dBlock);
    const auto head = encode_header({.parameter_block = 2,
                                     .points = 0,
                                     .first_frame = first,
                                     .last_frame = first + 1,
                                     .scale = -1.0F,
                                     .data_block = 4,
                                     .rate_hz = 50.0F},
                                    processor);
    std::vector<std::byte> out(head.begin(), head.end());
    out.insert(out.end(), section.begin(), section.end());
    const auto put = [&](const std::array<float, 9>& r, float trust) {
      std::array<float, 17> numbers{};
      for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t k = 0; k < 3; ++k) numbers[4 * column + k] = r[3 * column + k];
      numbers[12] = 900.0F;
      numbers[15] = 1.0F;
      numbers[16] = trust;
      for (const float value : numbers) {
        out.resize(out.size() + 4);
        store_f32(out.data() + out.size() - 4, value, processor);
      }
    };
    const std::array<float, 9> same{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<float, 9> turned{0, stretch, 0, -1, 0, 0, 0, 0, 1};  // columns: x is turned to y
    for (int f = 0; f < static_cast<int>(2 * ratio); ++f) {
      put(same, 0.0F);
      put(turned, f == 1 ? -1.0F : 0.5F);
    }
    out.resize(out.size() - cut);
    return out;
  }
  [[nodiscard]] Result<data::Orientations> read() const {
    const auto held = bytes();
    const auto reader = C3dReader::open(std::make_unique<MemorySource>(held, "t.c3d"));
    if (!reader) return std::unexpected(reader.error());
    return read_rotations(*reader, MemorySource(held, "t.c3d"));
  }
};

TEST(C3dRotations, AreOrientationsOfSegments) {
  for (const auto processor : {Processor::intel, Processor::dec, Processor::mips}) {
    RotationFile file;
    file.processor = processor;
    const auto read = file.read();
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_THAT(read->names, ElementsAre("pelvis", "thigh"));
    EXPECT_EQ(read->time.rate_hz, 50.0);
    EXPECT_EQ(read->frames(), 2);
    EXPECT_TRUE(read->rotation(1, 0).isIdentity(1e-12));
    EXPECT_TRUE((read->rotation(0, 1) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-6));
    EXPECT_FALSE(read->present(1, 1));
    EXPECT_THAT(read->warnings, Not(Contains(HasSubstr("has no points"))));
  }
}

TEST(C3dRotations, SeveralAFrame) {
  RotationFile file;
  file.ratio = 3.0;
  const auto read = file.read().value();
  EXPECT_EQ(read.frames(), 6);
  EXPECT_EQ(read.time.rate_hz, 150.0);
}

TEST(C3dRotations, HaveTheClockOfTheMarkers) {
  RotationFile file;
  file.first = 51;
  EXPECT_NEAR(file.read().value().time.t0_s, 1.0, 1e-12) << "frame 51 at 50 Hz, the first frame being at 0";
}

TEST(C3dRotations, SayWhatIsWrong) {
  const auto message = [](const RotationFile& file) { return file.read().error().message; };
  EXPECT_THAT(message({.has_group = false}), HasSubstr("no ROTATION group"));
  EXPECT_THAT(message({.used = 3.0}), HasSubstr("USED is 3, with 2 labels"));
  EXPECT_THAT(message({.used = 0.0}), HasSubstr("USED is 0"));
  EXPECT_THAT(message({.start = 900.0}), HasSubstr("DATA_START is 900"));
  EXPECT_THAT(message({.start = 0.0}), HasSubstr("DATA_START is 0"));
  EXPECT_THAT(message({.stretch = 1.2F}), HasSubstr("'thigh', frame 1: the matrix is no rotation"));
  EXPECT_THAT(message({.stretch = -1.0F}), HasSubstr("the matrix is no rotation"));
  EXPECT_THAT(message({.cut = 100}), HasSubstr("ROTATION has 1 of 2 frames"));
}

TEST(C3dRotations, OfTheia) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto read = read_c3d_rotations(data / "ezc3d-testFiles/C3DRotationExample.c3d").value();
  EXPECT_EQ(read.size(), 21);
  EXPECT_EQ(read.frames(), 340);
  EXPECT_EQ(read.time.rate_hz, 85.0);
  EXPECT_THAT(read.names, Contains("l_thigh"));
  EXPECT_FALSE(read.present(0, 1)) << "the pelvis is not seen in the first frame";
  EXPECT_NEAR(read.rotation(100, 2)(0, 0), 0.993352652, 1e-6);
  EXPECT_NEAR(read.rotation(100, 2)(1, 0), 0.113576911, 1e-6);
  EXPECT_NEAR(read.rotation(100, 2)(0, 1), -0.109148152, 1e-6);
}

}  // namespace
}  // namespace kinemark::io
