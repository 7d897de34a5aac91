// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kinemark/core/check.h"
#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/writer.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using data::Trial;
using internal::simulate_trial;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The bytes of a simulated file, to be damaged and read again.
class Bytes {
 public:
  explicit Bytes(const Trial& trial, const C3dWriteOptions& options = {}) {
    const testing_support::ScratchFolder scratch;
    EXPECT_TRUE(write_c3d(scratch / "t.c3d", trial, options));
    const std::string text = read_text(scratch / "t.c3d").value();
    bytes_.resize(text.size());
    std::memcpy(bytes_.data(), text.data(), text.size());
  }
  [[nodiscard]] std::vector<std::byte>& raw() { return bytes_; }
  void put(std::size_t at, int byte) { bytes_.at(at) = static_cast<std::byte>(byte); }
  void put_u16(std::size_t at, int value) {
    store_u16(bytes_.data() + at, static_cast<std::uint16_t>(value), Processor::intel);
  }
  void put_f32(std::size_t at, float value) { store_f32(bytes_.data() + at, value, Processor::intel); }
  /// Byte of the first value of a parameter with that name.
  [[nodiscard]] std::size_t find(std::string_view name, std::size_t dims) const {
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const std::size_t at = text.find(name);
    EXPECT_NE(at, std::string_view::npos) << name;
    return at + name.size() + 4 + dims;
  }
  [[nodiscard]] Result<C3dReader> open() const {
    return C3dReader::open(std::make_unique<MemorySource>(bytes_, "memory.c3d"));
  }
  [[nodiscard]] Result<Trial> read() const {
    const auto reader = open();
    if (!reader) return std::unexpected(reader.error());
    return read_trial(*reader);
  }

 private:
  std::vector<std::byte> bytes_;
};

bool same_bits(const auto& a, const auto& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

TEST(C3dReader, PiecesOfAFileAreThoseOfTheWhole) {
  const Bytes bytes(simulate_trial({.markers = 150, .frames = 90, .channels = 3}));
  const auto reader = bytes.open().value();
  const Trial whole = read_trial(reader).value();
  for (const std::int64_t piece : {1, 7, 90}) {
    Array<double> x(static_cast<std::size_t>(piece * 150 * 3));
    Array<double> analog(static_cast<std::size_t>(piece * 12));
    C3dSeen seen;
    for (std::int64_t f = 0; f + piece <= 90; f += piece) {
      seen += reader.read(f, piece, {.x_in_world = x, .analog = analog}).value();
      ASSERT_EQ(std::memcmp(x.data(), whole.markers.x_in_world.data() + f * 450, x.size() * sizeof(double)),
                0);
      ASSERT_EQ(
          std::memcmp(analog.data(), whole.analog.values.data() + f * 12, analog.size() * sizeof(double)), 0);
    }
    const bool all = 90 % piece == 0;
    EXPECT_TRUE(!all || seen.measured == std::ranges::count(whole.markers.state, SampleState::measured));
  }
  Array<double> small(3);
  EXPECT_THROW(static_cast<void>(reader.read(0, 2, {.x_in_world = small})), ContractError);
  EXPECT_THROW(static_cast<void>(reader.read(80, 11, {})), ContractError);
}

TEST(C3dReader, SameBitsForAnyNumberOfThreads) {
  const Bytes bytes(simulate_trial({.markers = 40, .frames = 3001, .channels = 2}));
  const auto reader = bytes.open().value();
  const Trial one = read_trial(reader, {.threads = 1}).value();
  for (const int threads : {2, 3, 0}) {
    const Trial many = read_trial(reader, {.threads = threads}).value();
    EXPECT_TRUE(same_bits(one.markers.x_in_world, many.markers.x_in_world));
    EXPECT_TRUE(same_bits(one.markers.state, many.markers.state));
    EXPECT_TRUE(same_bits(one.residual_m, many.residual_m));
    EXPECT_TRUE(same_bits(one.analog.values, many.analog.values));
  }
}

TEST(C3dReader, TellsTheBoxAroundAllSamples) {
  for (const bool integers : {false, true}) {
    const Trial trial = simulate_trial({.markers = 150, .frames = 700});
    const Bytes bytes(trial, {.integers = integers});
    const auto reader = bytes.open().value();
    C3dSeen one, many;
    const Trial read = read_trial(reader, {.threads = 1}, &one).value();
    ASSERT_TRUE(read_trial(reader, {.threads = 3}, &many));
    EXPECT_EQ(one.box_m.min(), many.box_m.min());
    EXPECT_EQ(one.box_m.max(), many.box_m.max());
    Eigen::AlignedBox3d needed;
    for (std::int64_t f = 0; f < read.markers.frames(); ++f)
      for (std::int64_t m = 0; m < read.markers.markers(); ++m)
        if (read.markers.present(f, m)) needed.extend(Eigen::Vector3d(read.markers.x(f, m)));
    EXPECT_TRUE(one.box_m.contains(needed));
    // What is not there is stored as 0.
    EXPECT_TRUE(needed.extend(Eigen::Vector3d::Zero()).contains(one.box_m));
  }
}

TEST(C3dReader, TellsNoBoxOfWhatIsNotRead) {
  const Bytes bytes(simulate_trial({.channels = 3}));
  C3dSeen seen;
  ASSERT_TRUE(read_trial(bytes.open().value(), {.points = false}, &seen));
  EXPECT_TRUE(seen.box_m.isEmpty());
}

TEST(C3dReader, ReadsOnlyWhatIsAskedFor) {
  const Bytes bytes(simulate_trial({.channels = 3}));
  const auto reader = bytes.open().value();
  const Trial no_analog = read_trial(reader, {.residuals = false, .analog = false}).value();
  EXPECT_TRUE(no_analog.validate());
  EXPECT_TRUE(no_analog.residual_m.empty());
  EXPECT_EQ(no_analog.analog.names.size(), 3U);
  EXPECT_EQ(no_analog.analog.samples, 0);
  const Trial no_points = read_trial(reader, {.points = false}).value();
  EXPECT_TRUE(no_points.validate());
  EXPECT_EQ(no_points.markers.markers(), 0);
  EXPECT_EQ(no_points.analog.samples, 200);
}

TEST(C3dReader, FourthWordsMeanWhatC3dOrgSays) {
  Trial trial = simulate_trial({.markers = 8, .frames = 1, .gaps = false, .residuals = false});
  Bytes bytes(trial);
  const auto layout = bytes.open().value().layout();
  const auto word = [&](std::size_t m, float w) { bytes.put_f32(layout.data_offset + 16 * m + 12, w); };
  word(0, -1.0F);
  word(1, 65535.0F);
  word(2, NAN);
  word(3, 0.0F);
  word(4, 256.0F * 5 + 7);  // cameras 1 and 3, seven steps
  word(5, 256.0F * 64);     // camera 7, a residual below half a step
  word(6, -0.0F);
  word(7, 2.5F);  // a fraction belongs to the residual
  const Trial t = bytes.read().value();
  const auto step = static_cast<float>(layout.scale * 1e-3);
  EXPECT_THAT(t.markers.state,
              ElementsAre(SampleState::missing, SampleState::missing, SampleState::missing,
                          SampleState::interpolated, SampleState::measured, SampleState::measured,
                          SampleState::interpolated, SampleState::measured));
  EXPECT_THAT(t.camera_mask, ElementsAre(0, 0, 0, 0, 5, 64, 0, 0));
  EXPECT_FLOAT_EQ(t.residual_m[4], 7 * step);
  EXPECT_EQ(t.residual_m[5], 0.0F);
  EXPECT_FLOAT_EQ(t.residual_m[7], 2.5F * step);
  EXPECT_TRUE(std::isnan(t.residual_m[3]));
}

TEST(C3dReader, CoordinatesThatAreNoneAreMissing) {
  Bytes bytes(simulate_trial({.markers = 4, .frames = 1, .gaps = false}));
  const std::size_t at = bytes.open().value().layout().data_offset;
  bytes.put_f32(at + 4, NAN);
  bytes.put_f32(at + 16, HUGE_VALF);
  for (const std::size_t axis : {0U, 4U, 8U}) bytes.put_f32(at + 32 + axis, 0.0F);
  const Trial t = bytes.read().value();
  EXPECT_EQ(t.markers.count_missing(), 3);
  EXPECT_TRUE(t.validate());
  EXPECT_TRUE(t.markers.present(0, 3));
}

TEST(C3dReader, BelievesParametersAndSaysSoWhenTheHeaderDiffers) {
  Bytes bytes(simulate_trial({.markers = 5, .frames = 100}));
  bytes.put_u16(2, 9);
  bytes.put_f32(20, 60.0F);
  bytes.put_u16(8, 50);
  const Trial t = bytes.read().value();
  EXPECT_EQ(t.markers.markers(), 5);
  EXPECT_EQ(t.markers.frames(), 100);
  EXPECT_EQ(t.markers.time.rate_hz, 240.0);
  EXPECT_THAT(t.warnings,
              AllOf(Contains(HasSubstr("the header 9 points")), Contains(HasSubstr("the header says 60 Hz")),
                    Contains(HasSubstr("the header 50; the parameter is used"))));
}

TEST(C3dReader, BelievesTheHeaderWhereOnlyItsNumbersFitTheFile) {
  Bytes bytes(simulate_trial({.markers = 5, .frames = 100}));
  bytes.put_u16(bytes.find("USED", 0), 11);
  const Trial t = bytes.read().value();
  EXPECT_EQ(t.markers.markers(), 5);
  EXPECT_EQ(t.markers.frames(), 100);
  EXPECT_THAT(t.warnings, Contains(HasSubstr("only the header's fit the file")));
}

TEST(C3dReader, BelievesTheFilesSizeWhenAllCountsLie) {
  // 66016 frames of 16 bytes fill their last block.
  Bytes bytes(simulate_trial({.markers = 1, .frames = 66016, .gaps = false}));
  bytes.put_f32(bytes.find("LONG_FRAMES", 0), 65535.0F);
  bytes.put_u16(bytes.find("ACTUAL_END_FIELD", 1), 65535);
  bytes.put_u16(bytes.find("ACTUAL_END_FIELD", 1) + 2, 0);
  const Trial t = bytes.read().value();
  EXPECT_EQ(t.markers.frames(), 66016);
  EXPECT_THAT(t.warnings, Contains(HasSubstr("states 65535 frames, the file holds 66016")));
}

TEST(C3dReader, AFileCutShortGivesItsWholeFrames) {
  Bytes bytes(simulate_trial({.markers = 10, .frames = 100}));
  const auto layout = bytes.open().value().layout();
  bytes.raw().resize(layout.data_offset + 41 * layout.frame_bytes + 17);
  const Trial t = bytes.read().value();
  EXPECT_EQ(t.markers.frames(), 41);
  EXPECT_THAT(
      t.warnings,
      Contains(HasSubstr("cut short: TRIAL:ACTUAL_END_FIELD states 100 frames, 41 whole ones are there")));
  bytes.raw().resize(layout.data_offset + 5);
  EXPECT_THAT(bytes.read().error().message, StartsWith("memory.c3d: ends before its first frame"));
}

TEST(C3dReader, WithoutParametersTheHeaderIsEnough) {
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    Bytes bytes(simulate_trial({.markers = 6, .frames = 30}), {.processor = processor});
    const Trial whole = bytes.read().value();
    for (std::size_t at = 512; at < bytes.open().value().layout().data_offset; ++at) bytes.put(at, 0xFF);
    const Trial t = bytes.read().value();
    EXPECT_EQ(t.markers.names[5], "point 6");
    for (std::size_t i = 0; i < t.markers.state.size(); ++i) {
      const auto was = whole.markers.state[i];
      const bool filled = was == SampleState::model_filled || was == SampleState::upsampled;
      ASSERT_EQ(t.markers.state[i], filled ? SampleState::interpolated : was) << to_string(processor);
    }
    EXPECT_THAT(t.warnings, Contains(HasSubstr("the header alone is used")));
  }
}

TEST(C3dReader, UnsignedAnalogSamplesGoPast32767) {
  Trial trial = simulate_trial({.frames = 1, .channels = 1, .samples_per_frame = 2});
  Bytes bytes(trial, {.integers = true});
  const auto layout = bytes.open().value().layout();
  const std::size_t sample = layout.data_offset + 8 * 7;
  bytes.put_u16(sample, 40000);
  bytes.put_u16(bytes.find("OFFSET", 1), 32768);
  const double step = layout.analog_scale[0];
  EXPECT_NEAR(bytes.read()->analog.values[0], (40000 - 65536 + 32768) * step, 1e-9);
  const std::size_t format = bytes.find("FORMAT", 1);
  std::memcpy(bytes.raw().data() + format, "UNSIGN", 6);
  EXPECT_NEAR(bytes.read()->analog.values[0], (40000 - 32768) * step, 1e-9);
}

TEST(C3dReader, AMisspeltUnitIsTakenForTheOneThatItIsLike) {
  Bytes bytes(simulate_trial({}), {.units = "meters"});
  const auto first = [](const Trial& trial) {
    const auto& x = trial.markers.x_in_world;
    return *std::ranges::find_if(x, [](double coordinate) { return std::isfinite(coordinate); });
  };
  const double x = first(bytes.read().value());
  std::memcpy(bytes.raw().data() + bytes.find("UNITS", 1), "metars", 6);
  Trial t = bytes.read().value();
  EXPECT_EQ(first(t), x);
  EXPECT_THAT(t.warnings, Contains("POINT:UNITS is 'metars', not a known length; taken for meter"));
  std::memcpy(bytes.raw().data() + bytes.find("UNITS", 1), "furlon", 6);
  t = bytes.read().value();
  EXPECT_NEAR(first(t), 1e-3 * x, 1e-12);
  EXPECT_THAT(t.warnings, Contains("POINT:UNITS is 'furlon', not a known length; mm is assumed"));
}

TEST(C3dReader, NonsenseForcePlatesAreLeftOut) {
  Trial trial = simulate_trial({.channels = 6});
  trial.force_plates.push_back({.type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}});
  Bytes bytes(trial);
  bytes.put_u16(bytes.find("CHANNEL", 2) + 4, 99);
  const Trial t = bytes.read().value();
  EXPECT_TRUE(t.force_plates.empty());
  EXPECT_THAT(t.warnings, Contains(HasSubstr("force plate 1 is left out")));
}

TEST(C3dReader, DuplicateAndMissingLabelsBecomeUniqueNames) {
  Trial trial = simulate_trial({.markers = 4});
  trial.markers.names = {"AAAA", "BBBB", "CCCC", "DDDD"};
  Bytes bytes(trial);
  const std::size_t at = bytes.find("AAAA", 0) - 8;
  std::memcpy(bytes.raw().data() + at, "BBBBBBBBBBBB    ", 16);
  const Trial t = bytes.read().value();
  EXPECT_THAT(t.markers.names, ElementsAre("BBBB", "BBBB_2", "BBBB_3", "point 4"));
  EXPECT_THAT(t.warnings,
              AllOf(Contains(HasSubstr("repeats 2 names")), Contains(HasSubstr("names 3 of 4 points"))));
}

TEST(C3dReader, WhatIsNoC3dFileIsOneSentence) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(read_c3d(scratch / "none.c3d").error().code, Code::io);
  ASSERT_TRUE(write_text(scratch / "text.c3d", std::string(2000, 'x'), false));
  const Error error = read_c3d(scratch / "text.c3d").error();
  EXPECT_EQ(error.code, Code::bad_input);
  EXPECT_THAT(error.message, AllOf(HasSubstr("text.c3d: is not a C3D file: its second byte is 120, need 80"),
                                   Not(HasSubstr("\n"))));
  Bytes bytes(simulate_trial({}));
  bytes.put_f32(12, 0.0F);
  bytes.put_f32(bytes.find("SCALE", 0), 0.0F);
  EXPECT_THAT(bytes.read().error().message, HasSubstr("parameter POINT:SCALE is 0; need < 0"));
  bytes = Bytes(simulate_trial({}));
  bytes.put_f32(20, 0.0F);
  bytes.put_f32(bytes.find("RATE", 0), -3.0F);
  EXPECT_THAT(bytes.read().error().message, HasSubstr("POINT:RATE is -3; expected a frame rate"));
  bytes = Bytes(simulate_trial({}));
  bytes.put_f32(bytes.find("RATE", 0), 0.0F);
  EXPECT_THAT(bytes.read().value().warnings,
              AllOf(Contains("POINT:RATE is 0, which is taken as not known"),
                    Contains(HasSubstr("the header's rate of 240 Hz is used"))));
  bytes.put_f32(20, 0.0F);
  EXPECT_THAT(bytes.read().error().message, HasSubstr("has no frame rate"));
  bytes = Bytes(simulate_trial({}));
  bytes.put_u16(16, 9000);
  bytes.put_u16(bytes.find("DATA_START", 0), 9001);
  EXPECT_THAT(bytes.read().error().message, HasSubstr("points to its data at block 9001"));
}

TEST(C3dReader, OtherUnitsBecomeMetres) {
  const Trial trial = simulate_trial({.gaps = false});
  for (const char* unit : {"m", "cm", "in"}) {
    const Trial back = Bytes(trial, {.units = unit}).read().value();
    EXPECT_NEAR((back.markers.x(9, 3) - trial.markers.x(9, 3)).norm(), 0.0, 4e-7) << unit;
    EXPECT_NEAR(back.residual_m[5], trial.residual_m[5], 4e-5) << unit;
  }
}

}  // namespace
}  // namespace kinemark::io
