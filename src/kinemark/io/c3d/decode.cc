// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/decode.h"

#include <cmath>
#include <limits>

namespace kinemark::io {
namespace {

using data::SampleState;

/// One point as stored, before units.
struct Raw {
  double x, y, z;
  float steps;  ///< residual in steps of the scale, below 0 where the fourth word calls it missing
  std::uint8_t mask;
};

template <class Numbers>
struct FloatSamples {
  static constexpr std::size_t kBytes = 4;
  static Raw point(const std::byte* p) {
    const float w = Numbers::f32(p + 12);
    // A word that is NaN fails the comparison, too. Positive words above 32767 have an eighth camera.
    const bool there = w >= 0.0F && w < 65535.0F;
    const int word = static_cast<int>(there ? w : 0.0F);
    return {Numbers::f32(p), Numbers::f32(p + 4), Numbers::f32(p + 8),
            there ? w - static_cast<float>(word & 0xFF00) : -1.0F, static_cast<std::uint8_t>(word >> 8)};
  }
  static double analog(const std::byte* p, bool) { return Numbers::f32(p); }
};

template <class Numbers>
struct IntegerSamples {
  static constexpr std::size_t kBytes = 2;
  static double i16(const std::byte* p) { return static_cast<std::int16_t>(Numbers::u16(p)); }
  static Raw point(const std::byte* p) {
    const std::uint16_t w = Numbers::u16(p + 6);
    const bool there = w < 0x8000U;
    return {i16(p), i16(p + 2), i16(p + 4), there ? static_cast<float>(w & 0xFFU) : -1.0F,
            static_cast<std::uint8_t>(there ? w >> 8 : 0)};
  }
  static double analog(const std::byte* p, bool is_unsigned) {
    return is_unsigned ? static_cast<double>(Numbers::u16(p)) : i16(p);
  }
};

/// Cursor into the outputs; null where a span is empty.
struct Cursor {
  double* x;
  SampleState* state;
  float* residual;
  std::uint8_t* mask;
};

template <class Samples>
C3dSeen decode_points(const std::byte* in, std::int64_t points, double metres_per_step, float residual_step_m,
                      const Cursor& out) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  C3dSeen seen;
  for (std::int64_t m = 0; m < points; ++m) {
    const Raw raw = Samples::point(in + static_cast<std::size_t>(m) * 4 * Samples::kBytes);
    // x - x is 0 for finite numbers only.
    const bool finite = (raw.x - raw.x) + (raw.y - raw.y) + (raw.z - raw.z) == 0.0;
    const bool origin = raw.x == 0.0 && raw.y == 0.0 && raw.z == 0.0;
    const bool there = raw.steps >= 0.0F && finite && !origin;
    const bool measured = there && (raw.steps > 0.0F || raw.mask != 0);
    seen.measured += measured;
    seen.unmeasured += there && !measured;
    seen.with_cameras += there && raw.mask != 0;
    if (out.x != nullptr) {
      out.x[3 * m] = there ? raw.x * metres_per_step : kNaN;
      out.x[3 * m + 1] = there ? raw.y * metres_per_step : kNaN;
      out.x[3 * m + 2] = there ? raw.z * metres_per_step : kNaN;
    }
    if (out.state != nullptr)
      out.state[m] = measured ? SampleState::measured
                     : there  ? SampleState::interpolated
                              : SampleState::missing;
    if (out.residual != nullptr)
      out.residual[m] = measured ? raw.steps * residual_step_m : std::numeric_limits<float>::quiet_NaN();
    if (out.mask != nullptr) out.mask[m] = there ? raw.mask : std::uint8_t{0};
  }
  return seen;
}

template <class Samples>
void decode_analog(const C3dLayout& layout, const std::byte* in, double* out) {
  const auto channels = static_cast<std::size_t>(layout.analog_channels);
  const bool is_unsigned = layout.analog_unsigned;
  for (std::int64_t s = 0; s < layout.samples_per_frame; ++s) {
    for (std::size_t k = 0; k < channels; ++k)
      out[k] = (Samples::analog(in + k * Samples::kBytes, is_unsigned) - layout.analog_offset[k]) *
               layout.analog_scale[k];
    in += channels * Samples::kBytes;
    out += channels;
  }
}

template <class Samples>
C3dSeen decode(const C3dLayout& layout, const std::byte* in, std::int64_t frames, const C3dFrames& out) {
  const auto points = static_cast<std::size_t>(layout.points);
  const double metres_per_step = layout.metres_per_unit * (layout.is_float ? 1.0 : layout.scale);
  const auto residual_step_m = static_cast<float>(layout.metres_per_unit * layout.scale);
  C3dSeen seen;
  for (std::int64_t f = 0; f < frames; ++f, in += layout.frame_bytes) {
    const auto frame = static_cast<std::size_t>(f);
    const auto at = [&](auto span, std::size_t width) {
      return span.empty() ? nullptr : span.data() + frame * width;
    };
    const Cursor cursor{at(out.x_in_world, 3 * points), at(out.state, points), at(out.residual_m, points),
                        at(out.camera_mask, points)};
    seen += decode_points<Samples>(in, layout.points, metres_per_step, residual_step_m, cursor);
    if (!out.analog.empty())
      decode_analog<Samples>(layout, in + points * 4 * Samples::kBytes,
                             at(out.analog, static_cast<std::size_t>(layout.analog_per_frame())));
  }
  return seen;
}

}  // namespace

C3dSeen& C3dSeen::operator+=(const C3dSeen& other) {
  measured += other.measured;
  unmeasured += other.unmeasured;
  with_cameras += other.with_cameras;
  return *this;
}

C3dSeen decode_frames(const C3dLayout& layout, const std::byte* bytes, std::int64_t frames,
                      const C3dFrames& out) {
  if (!layout.is_float)
    return layout.processor == Processor::mips
               ? decode<IntegerSamples<MipsNumbers>>(layout, bytes, frames, out)
               : decode<IntegerSamples<IntelNumbers>>(layout, bytes, frames, out);
  switch (layout.processor) {
    case Processor::dec:
      return decode<FloatSamples<DecNumbers>>(layout, bytes, frames, out);
    case Processor::mips:
      return decode<FloatSamples<MipsNumbers>>(layout, bytes, frames, out);
    case Processor::intel:
      break;
  }
  return decode<FloatSamples<IntelNumbers>>(layout, bytes, frames, out);
}

}  // namespace kinemark::io
