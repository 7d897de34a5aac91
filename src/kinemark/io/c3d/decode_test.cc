// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Frames decoded by the rules of c3d.org, written a second time in the plainest way.
#include "kinemark/io/c3d/decode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::io {
namespace {

using data::SampleState;

constexpr std::int64_t kDecodedFrames = 7;

/// Markers 0 to 2 and 5 to 79, channels 3 and 4, three analog channels of two samples.
C3dLayout mixed_layout(Processor processor, bool is_float) {
  C3dLayout l{.processor = processor, .is_float = is_float, .points = 80, .markers = 78};
  l.runs = {{.first = 0, .count = 3}, {.first = 5, .count = 75}};
  l.channel_points = {3, 4};
  l.frames = kDecodedFrames;
  l.scale = 0.125;
  l.metres_per_unit = 1e-3;
  l.analog_channels = 3;
  l.samples_per_frame = 2;
  l.analog_scale = {1.0, 0.5, -2.0};
  l.analog_offset = {0.0, 10.0, 100.0};
  l.frame_bytes = static_cast<std::size_t>(4 * 80 + 6) * (is_float ? 4 : 2);
  return l;
}

/// The numbers of a file, first as plain ones, then as its bytes.
struct Stored {
  std::vector<double> numbers;  // frame by frame
  std::vector<std::byte> bytes;

  Stored(const C3dLayout& layout, std::uint64_t seed) : bytes(kDecodedFrames * layout.frame_bytes) {
    Random random(seed, 1);
    const std::size_t per_frame = layout.frame_bytes / (layout.is_float ? 4 : 2);
    for (std::size_t i = 0; i < kDecodedFrames * per_frame; ++i) {
      const std::size_t place = i % per_frame;
      double v = std::floor(random.uniform(-2000.0, 2000.0));
      if (place < 320 && place % 4 == 3) v = word(random, layout.is_float);
      if (place < 320 && place % 4 != 3 && place / 4 % 9 == 1) v = 0.0;
      numbers.push_back(v);
      if (layout.is_float)
        store_f32(bytes.data() + 4 * i, static_cast<float>(v), layout.processor);
      else
        store_u16(bytes.data() + 2 * i, static_cast<std::uint16_t>(static_cast<std::int64_t>(v)),
                  layout.processor);
    }
  }
  /// A fourth word of any kind: not seen, made, with a residual, with cameras.
  static double word(Random& random, bool is_float) {
    const double residual = std::floor(random.uniform(0.0, 256.0)),
                 mask = std::floor(random.uniform(0.0, 128.0));
    switch (static_cast<int>(random.uniform(0.0, 6.0))) {
      case 0:
        return -1.0;
      case 1:
        return 0.0;
      case 2:
        return residual;
      case 3:
        return 256.0 * mask;
      case 4:
        return is_float ? 65535.0 : -32768.0;
      default:
        return 256.0 * mask + residual;
    }
  }
};

struct Decoded {
  std::vector<double> x, analog, channels;
  std::vector<SampleState> state;
  std::vector<float> residual;
  std::vector<std::uint8_t> mask;
  C3dSeen seen;

  Decoded(const C3dLayout& l, const std::byte* bytes, std::int64_t frames)
      : x(static_cast<std::size_t>(3 * frames * l.markers)),
        analog(static_cast<std::size_t>(frames * l.analog_per_frame())),
        channels(static_cast<std::size_t>(frames) * 3 * l.channel_points.size()),
        state(x.size() / 3),
        residual(x.size() / 3),
        mask(x.size() / 3),
        seen(decode_frames(l, bytes, frames, {x, state, residual, mask, analog, channels})) {}
};

bool alike(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 1e-9 * std::abs(a);
}

class Decode : public ::testing::TestWithParam<std::tuple<Processor, bool>> {};

TEST_P(Decode, EverySampleIsWhatItsNumbersSay) {
  const auto [processor, is_float] = GetParam();
  const C3dLayout layout = mixed_layout(processor, is_float);
  const Stored stored(layout, 4);
  const Decoded d(layout, stored.bytes.data(), kDecodedFrames);
  const double unit = is_float ? 1.0 : layout.scale;
  std::size_t i = 0, c = 0;
  C3dSeen seen;
  for (std::int64_t f = 0; f < kDecodedFrames; ++f)
    for (std::int64_t p = 0; p < 80; ++p) {
      const double* v = stored.numbers.data() + f * 326 + 4 * p;
      const auto word = static_cast<int>(v[3]);
      const bool marked = v[3] >= 0.0 && v[3] < 65535.0;
      if (p == 3 || p == 4) {
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_TRUE(alike(d.channels[c++], marked ? unit * v[axis] : kNaN)) << f << " " << p;
        continue;
      }
      const bool there = marked && (v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0);
      const int cameras = there ? word / 256 : 0;
      const bool measured = there && word != 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_TRUE(alike(d.x[3 * i + axis], there ? 1e-3 * unit * v[axis] : kNaN)) << f << " " << p;
      EXPECT_EQ(d.state[i], measured ? SampleState::measured
                            : there  ? SampleState::interpolated
                                     : SampleState::missing);
      EXPECT_EQ(d.mask[i], cameras) << f << " " << p;
      const double residual = 1e-3 * layout.scale * (word % 256);
      if (measured) {
        EXPECT_NEAR(d.residual[i], residual, 1e-6 * residual) << f << " " << p;
      } else {
        EXPECT_TRUE(std::isnan(d.residual[i])) << f << " " << p;
      }
      seen.measured += measured;
      seen.unmeasured += there && !measured;
      seen.with_cameras += cameras != 0;
      ++i;
    }
  EXPECT_EQ(i, d.state.size());
  EXPECT_EQ(d.seen.measured, seen.measured);
  EXPECT_EQ(d.seen.unmeasured, seen.unmeasured);
  EXPECT_EQ(d.seen.with_cameras, seen.with_cameras);
  EXPECT_GT(seen.measured * seen.unmeasured * seen.with_cameras, 0) << "all kinds occur";
}

TEST_P(Decode, AnalogNumbersAreScaledAfterTheirOffset) {
  const auto [processor, is_float] = GetParam();
  const C3dLayout layout = mixed_layout(processor, is_float);
  const Stored stored(layout, 5);
  const Decoded d(layout, stored.bytes.data(), kDecodedFrames);
  for (std::size_t f = 0; f < kDecodedFrames; ++f)
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_DOUBLE_EQ(
          d.analog[6 * f + k],
          (stored.numbers[326 * f + 320 + k] - layout.analog_offset[k % 3]) * layout.analog_scale[k % 3]);
}

TEST_P(Decode, PiecesAddUpToTheWhole) {
  const auto [processor, is_float] = GetParam();
  const C3dLayout layout = mixed_layout(processor, is_float);
  const Stored stored(layout, 6);
  const Decoded whole(layout, stored.bytes.data(), kDecodedFrames);
  const Decoded first(layout, stored.bytes.data(), 3),
      rest(layout, stored.bytes.data() + 3 * layout.frame_bytes, 4);
  C3dSeen sum = first.seen;
  sum += rest.seen;
  EXPECT_EQ(sum.measured, whole.seen.measured);
  EXPECT_EQ(sum.unmeasured, whole.seen.unmeasured);
  EXPECT_EQ(sum.with_cameras, whole.seen.with_cameras);
  EXPECT_TRUE(sum.box_m.isApprox(whole.seen.box_m));
  std::vector<SampleState> joined = first.state;
  joined.insert(joined.end(), rest.state.begin(), rest.state.end());
  EXPECT_EQ(joined, whole.state);
}

TEST_P(Decode, TheBoxHoldsEveryPosition) {
  const auto [processor, is_float] = GetParam();
  const C3dLayout layout = mixed_layout(processor, is_float);
  const Stored stored(layout, 7);
  const Decoded d(layout, stored.bytes.data(), kDecodedFrames);
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < d.state.size(); ++i)
    if (d.state[i] != SampleState::missing)
      box.extend(Eigen::Vector3d(d.x[3 * i], d.x[3 * i + 1], d.x[3 * i + 2]));
  EXPECT_TRUE(d.seen.box_m.contains(box));
  const C3dSeen unasked = decode_frames(layout, stored.bytes.data(), kDecodedFrames, {});
  EXPECT_TRUE(unasked.box_m.isEmpty()) << "no position was written";
  EXPECT_EQ(unasked.measured, d.seen.measured) << "but all were counted";
}

INSTANTIATE_TEST_SUITE_P(Encodings, Decode,
                         ::testing::Combine(::testing::Values(Processor::intel, Processor::dec,
                                                              Processor::mips),
                                            ::testing::Bool()));

TEST(DecodeFloats, WhatIsNoFiniteCoordinateIsMissing) {
  C3dLayout layout{.points = 4, .markers = 4, .frames = 1, .frame_bytes = 64};
  layout.runs = {{.first = 0, .count = 4}};
  std::vector<std::byte> bytes(64);
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const float numbers[16] = {inf, 1, 1, 1, 1, nan, 1, 1, 1, 1, 1, nan, 0, -0.0F, 1e-40F, 1};
  for (std::size_t i = 0; i < 16; ++i) store_f32(bytes.data() + 4 * i, numbers[i], Processor::intel);
  const Decoded d(layout, bytes.data(), 1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(d.state[i], SampleState::missing) << i;
  EXPECT_EQ(d.state[3], SampleState::measured) << "next to nothing is not nothing";
}

}  // namespace
}  // namespace kinemark::io
