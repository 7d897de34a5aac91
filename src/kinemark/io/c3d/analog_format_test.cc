// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/analog_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/io/c3d/decode.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::int64_t kFrames = 200, kPerFrame = 5, kSamples = kFrames * kPerFrame;
constexpr double kScale = 1e-3;

/// Counts of a channel about the middle of its range, by sample.
using Signal = std::function<double(std::int64_t)>;

/// What a file holds of its channels, and how it says so.
struct Planted {
  std::vector<Signal> signals;
  double middle = 0.0;  ///< counts in which 0 is stored; 32768 where words are unsigned
  std::string format;   ///< ANALOG:FORMAT; empty: missing
  C3dType offset_type = C3dType::int16;
  double bits = 16.0;
  Processor processor = Processor::intel;
};

struct Read {
  std::vector<double> values;  ///< of all samples, as they come out
  std::vector<std::string> warnings;
};

Read read_planted(const Planted& planted) {
  const std::size_t channels = planted.signals.size();
  C3dLayout layout{.processor = planted.processor,
                   .is_float = false,
                   .points = 1,
                   .frames = kFrames,
                   .analog_channels = std::ssize(planted.signals),
                   .samples_per_frame = kPerFrame,
                   .analog_scale = std::vector<double>(channels, kScale)};
  layout.frame_bytes = 2 * (4 + channels * kPerFrame);
  std::vector<std::byte> bytes(layout.frame_bytes * kFrames);
  for (std::int64_t i = 0; i < kSamples; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      const auto frame = static_cast<std::size_t>(i / kPerFrame),
                 sample = static_cast<std::size_t>(i % kPerFrame);
      const auto word = static_cast<std::int64_t>(std::llround(planted.signals[c](i) + planted.middle));
      store_u16(bytes.data() + frame * layout.frame_bytes + 8 + 2 * (sample * channels + c),
                static_cast<std::uint16_t>(word), planted.processor);
    }
  C3dParameters parameters;
  auto& analog = parameters.group("ANALOG");
  const bool wraps = planted.offset_type == C3dType::int16 && planted.middle > 32767.0;
  const double stored = wraps ? planted.middle - 65536.0 : planted.middle;  // as a file of 16 bits gives it
  analog.parameters.push_back(
      {.name = "OFFSET", .type = planted.offset_type, .numbers = std::vector<double>(channels, stored)});
  analog.parameters.push_back({.name = "BITS", .type = C3dType::int16, .numbers = {planted.bits}});
  if (!planted.format.empty())
    analog.parameters.push_back({.name = "FORMAT", .type = C3dType::text, .texts = {planted.format}});
  layout.analog_unsigned = planted.format == "UNSIGNED";
  // As settle_layout() has it.
  layout.analog_offset.assign(channels, layout.analog_unsigned && wraps ? planted.middle : stored);

  Read out;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < channels; ++c) names.push_back("A" + std::to_string(c + 1));
  const MemorySource source(bytes, "memory.c3d");
  EXPECT_TRUE(settle_analog_format(source, parameters, names, layout, out.warnings));
  out.values.resize(channels * kSamples);
  decode_frames(layout, bytes.data(), kFrames, {.analog = out.values});
  return out;
}

/// The largest difference to what was planted, in the unit of the channels.
double worst(const Planted& planted, const Read& read) {
  double out = 0.0;
  for (std::int64_t i = 0; i < kSamples; ++i)
    for (std::size_t c = 0; c < planted.signals.size(); ++c)
      out = std::max(out, std::abs(read.values[static_cast<std::size_t>(i) * planted.signals.size() + c] -
                                   kScale * std::round(planted.signals[c](i))));
  return out;
}

Signal sine(double amplitude, double period) {
  return [=](std::int64_t i) {
    return amplitude * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / period + 0.3);
  };
}

Signal noise(double sd, std::uint64_t seed) {
  std::vector<double> values;
  Random random(seed, 0);
  for (std::int64_t i = 0; i < kSamples; ++i) values.push_back(sd * random.gaussian());
  return [values](std::int64_t i) { return values[static_cast<std::size_t>(i)]; };
}

/// Between two levels, with noise about both.
Signal square(double level, double sd) {
  return [level, n = noise(sd, 8)](std::int64_t i) { return (i / 50 % 2 == 0 ? level : -level) + n(i); };
}

std::vector<Signal> usual() { return {sine(6000.0, 90.0), noise(40.0, 1), noise(900.0, 2)}; }

TEST(C3dAnalogFormat, WhatTheFileSaysRightlyIsRead) {
  for (const auto& [format, middle] : {std::pair{"SIGNED", 0.0},
                                       {"", 0.0},
                                       {"SIGNED", 2048.0},
                                       {"", 2048.0},
                                       {"UNSIGNED", 32768.0},
                                       {"UNSIGNED", 10'000.0},
                                       {"SIGNED", -2048.0}}) {
    const Planted planted{.signals = usual(), .middle = middle, .format = format};
    const Read read = read_planted(planted);
    EXPECT_LT(worst(planted, read), 1e-9) << format << middle;
    EXPECT_THAT(read.warnings, IsEmpty()) << format << middle;
  }
}

TEST(C3dAnalogFormat, UnsignedSamplesAreReadAsSuchWhateverTheFileSays) {
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips})
    for (const C3dType type : {C3dType::int16, C3dType::float32})
      for (const auto* format : {"", "SIGNED"})
        for (const double middle : {32'768.0, 31'000.0}) {
          const Planted planted{.signals = usual(),
                                .middle = middle,
                                .format = format,
                                .offset_type = type,
                                .processor = processor};
          const Read read = read_planted(planted);
          EXPECT_LT(worst(planted, read), 1e-9) << format << middle;
          ASSERT_EQ(read.warnings.size(), 1U);
          EXPECT_THAT(read.warnings[0],
                      StartsWith(*format == 0 ? "ANALOG:FORMAT is missing, but the 16-bit "
                                              : "ANALOG:FORMAT says 'SIGNED', but the 16-bit "));
          EXPECT_THAT(read.warnings[0], HasSubstr("samples are unsigned and read as such: as signed ones"));
          EXPECT_THAT(read.warnings[0], HasSubstr("as unsigned ones never"));
        }
}

TEST(C3dAnalogFormat, TheJumpsOfEachReadingAreCounted) {
  // Passes the middle twice a period of 100 samples, ten periods, one step each: and no other channel does.
  const Planted planted{.signals = {sine(6000.0, 100.0), [](std::int64_t) { return 2000.0; }},
                        .middle = 32'768.0};
  const auto read = read_planted(planted);
  EXPECT_THAT(read.warnings,
              ElementsAre(HasSubstr("as signed ones 1 channel jumps (A1) by nearly the whole range "
                                    "20 times from one sample to the next, as unsigned ones never")));
}

TEST(C3dAnalogFormat, SwitchesThatTrulyJumpAreNoEvidence) {
  // Beside EMG that wraps: channels that go from one end to the other in any reading.
  const Planted planted{.signals = {noise(700.0, 3), square(30'000.0, 4.0), noise(60.0, 9)},
                        .middle = 32'768.0};
  const auto read = read_planted(planted);
  EXPECT_LT(worst(planted, read), 1e-9);
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("as unsigned ones 19 times")));
}

TEST(C3dAnalogFormat, SignedSamplesAreReadAsSuchWhereTheFileSaysUnsigned) {
  for (const double middle : {0.0, 100.0}) {
    const Planted planted{.signals = usual(), .middle = middle, .format = "UNSIGNED"};
    const Read read = read_planted(planted);
    EXPECT_LT(worst(planted, read), 1e-9) << middle;
    EXPECT_THAT(read.warnings,
                ElementsAre(HasSubstr("says 'UNSIGNED', but the 16-bit samples are signed and")));
  }
}

TEST(C3dAnalogFormat, WithoutEvidenceWhatTheFileSaysStands) {
  const auto stands = [](std::vector<Signal> signals, const char* what, const char* format = "",
                         double middle = 0.0, double bits = 16.0) {
    const Planted planted{.signals = std::move(signals), .middle = middle, .format = format, .bits = bits};
    EXPECT_THAT(read_planted(planted).warnings, Not(testing::Contains(HasSubstr("ANALOG:FORMAT")))) << what;
  };
  stands({[](std::int64_t) { return 0.0; }}, "nothing happens");
  stands({[](std::int64_t) { return 33'000.0; }}, "a constant");
  stands({[](std::int64_t i) { return i / 50 % 2 == 0 ? 32'767.0 : -32'768.0; }}, "a channel that rails");
  stands({square(32'767.0, 0.0)}, "a channel at both ends of its range");
  stands({square(32'500.0, 6.0)}, "a channel near both ends of its range");
  stands({square(32'760.0, 2.0), noise(300.0, 5)}, "the same beside others that pass zero");
  stands({[](std::int64_t i) { return std::clamp(sine(90'000.0, 90.0)(i), -32'768.0, 32'767.0); }},
         "a clipped one");
  stands({[](std::int64_t i) { return sine(20'000.0, 500.0)(i) + (i % 400 == 9 ? 45'000.0 : 0.0); }},
         "wrapped spikes");
  stands({[](std::int64_t i) { return i % 100 == 9 ? -30'000.0 : 20'000.0 + static_cast<double>(i % 5); }},
         "single wrong samples");
  stands({noise(30'000.0, 4)}, "noise through the whole range, which jumps in both");
  stands({[](std::int64_t i) { return i % 7 == 0 ? 32'700.0 + static_cast<double>(i % 3) : 100.0; }},
         "one sign");
  stands({noise(900.0, 6)}, "12 bits are no 16", "UNSIGNED", 0.0, 12.0);
  stands({noise(900.0, 6)}, "14 bits are no 16", "UNSIGNED", 0.0, 14.0);
  stands({noise(900.0, 7)}, "12 bits as they should be", "", 2048.0, 12.0);
}

TEST(C3dAnalogFormat, FloatsAndFilesWithoutSamplesAreNotLookedAt) {
  const std::vector<std::byte> none;
  const MemorySource source(none, "none.c3d");
  std::vector<std::string> warnings;
  C3dLayout floats{
      .is_float = true, .frames = 9, .analog_channels = 1, .samples_per_frame = 1, .frame_bytes = 4};
  EXPECT_TRUE(settle_analog_format(source, {}, {"A"}, floats, warnings));
  C3dLayout empty{.is_float = false, .frames = 9, .frame_bytes = 8};
  EXPECT_TRUE(settle_analog_format(source, {}, {}, empty, warnings));
  // What is to be read and is not there is said.
  C3dLayout cut{
      .is_float = false, .frames = 9, .analog_channels = 1, .samples_per_frame = 1, .frame_bytes = 2};
  const auto status = settle_analog_format(source, {}, {"A"}, cut, warnings);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "none.c3d: became shorter while it was read");
  EXPECT_THAT(warnings, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io
