// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/decode.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace kinemark::io {
namespace {

using data::SampleState;

constexpr std::int64_t kBatch = 128;

/// Points of one frame, one array for each part so that the compiler can work on several at once. Truth is
/// ~0, falsehood 0.
struct Batch {
  float x[kBatch], y[kBatch], z[kBatch];
  float steps[kBatch];           ///< residual in steps of the scale; anything where missing
  std::int32_t cameras[kBatch];  ///< 0 where missing
  std::int32_t there[kBatch];
};

std::int32_t truth(bool condition) { return condition ? -1 : 0; }

/// a < b for numbers that are not negative, by the sign of their difference: a comparison would become a
/// jump.
std::int32_t less(std::int32_t a, std::int32_t b) { return (a - b) >> 31; }

template <class Numbers>
struct FloatSamples {
  static constexpr std::size_t kBytes = 4;

  static void load(const std::byte* p, std::int64_t n, Batch& out) {
    float w[kBatch];
    for (std::int64_t i = 0; i < n; ++i, p += 16) {
      out.x[i] = Numbers::f32(p);
      out.y[i] = Numbers::f32(p + 4);
      out.z[i] = Numbers::f32(p + 8);
      // Adding 0 turns -0 into 0: then the bits of positive numbers are positive and in their order.
      w[i] = Numbers::f32(p + 12) + 0.0F;
    }
    constexpr std::int32_t kMagnitude = 0x7FFFFFFF;
    constexpr std::int32_t kInfinity = 0x7F800000;
    constexpr auto kNoResidual = std::bit_cast<std::int32_t>(65535.0F);
    for (std::int64_t i = 0; i < n; ++i) {
      const std::int32_t ax = std::bit_cast<std::int32_t>(out.x[i]) & kMagnitude;
      const std::int32_t ay = std::bit_cast<std::int32_t>(out.y[i]) & kMagnitude;
      const std::int32_t az = std::bit_cast<std::int32_t>(out.z[i]) & kMagnitude;
      const auto bits = std::bit_cast<std::int32_t>(w[i]);
      const std::int32_t good = ~(bits >> 31) & less(bits & kMagnitude, kNoResidual);
      const float good_w = std::bit_cast<float>(bits & good);
      // Words from 32768 on have an eighth camera; a fraction belongs to the residual.
      const auto word = static_cast<std::int32_t>(good_w);
      out.there[i] =
          good & less(ax, kInfinity) & less(ay, kInfinity) & less(az, kInfinity) & less(0, ax | ay | az);
      out.steps[i] = good_w - static_cast<float>(word & 0xFF00);
      out.cameras[i] = (word >> 8) & out.there[i];
    }
  }
  static double analog(const std::byte* p, bool) { return Numbers::f32(p); }
};

template <class Numbers>
struct IntegerSamples {
  static constexpr std::size_t kBytes = 2;

  static void load(const std::byte* p, std::int64_t n, Batch& out) {
    for (std::int64_t i = 0; i < n; ++i, p += 8) {
      const auto x = static_cast<std::int16_t>(Numbers::u16(p));
      const auto y = static_cast<std::int16_t>(Numbers::u16(p + 2));
      const auto z = static_cast<std::int16_t>(Numbers::u16(p + 4));
      const std::int32_t w = Numbers::u16(p + 6);
      out.x[i] = x;
      out.y[i] = y;
      out.z[i] = z;
      out.there[i] = truth(w < 0x8000) & truth((x | y | z) != 0);
      out.steps[i] = static_cast<float>(w & 0xFF);
      out.cameras[i] = (w >> 8) & out.there[i];
    }
  }
  static double analog(const std::byte* p, bool is_unsigned) {
    const std::uint16_t v = Numbers::u16(p);
    return is_unsigned ? v : static_cast<std::int16_t>(v);
  }
};

/// The box around all samples so far, in the numbers of the file, one for each place in a batch: so the
/// compiler works on several at once. What stands in the place of missing samples counts, unless it is NaN,
/// which is neither less nor more: that costs nothing.
class Boxes {
 public:
  Boxes() {
    for (auto& axis : low_) std::ranges::fill(axis, std::numeric_limits<float>::infinity());
    for (auto& axis : high_) std::ranges::fill(axis, -std::numeric_limits<float>::infinity());
  }

  void add(const Batch& in, std::int64_t n) {
    add(in.x, n, low_[0], high_[0]);
    add(in.y, n, low_[1], high_[1]);
    add(in.z, n, low_[2], high_[2]);
  }

  [[nodiscard]] Eigen::AlignedBox3d metres(double metres_per_step) const {
    Eigen::AlignedBox3d out;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = std::ranges::min(low_[axis]), high = std::ranges::max(high_[axis]);
      if (low > high) return {};
      out.min()(axis) = metres_per_step * low;
      out.max()(axis) = metres_per_step * high;
    }
    return out;
  }

 private:
  static void add(const float* __restrict x, std::int64_t n, float* __restrict low, float* __restrict high) {
    for (std::int64_t i = 0; i < n; ++i) {
      low[i] = x[i] < low[i] ? x[i] : low[i];
      high[i] = x[i] > high[i] ? x[i] : high[i];
    }
  }

  float low_[3][kBatch], high_[3][kBatch];
};

/// Where the points of a batch go; null where a span is empty.
struct Cursor {
  double* x;
  SampleState* state;
  float* residual;
  std::uint8_t* mask;
};

struct Steps {
  double coordinate_m;
  float residual_m;
};

// Free of branches that depend on the data, because gaps cannot be predicted: a missing sample is multiplied
// by NaN instead.
void finish(const Batch& in, std::int64_t n, const Steps& steps, const Cursor& out, C3dSeen& total) {
  static_assert(static_cast<int>(SampleState::missing) == 0 && static_cast<int>(SampleState::measured) == 1 &&
                static_cast<int>(SampleState::interpolated) == 2);
  float residual[kBatch];
  std::int32_t state[kBatch];
  std::int32_t measured_count = 0;
  std::int32_t there_count = 0;
  std::int32_t camera_count = 0;
  constexpr auto kNaN = std::bit_cast<std::int32_t>(std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int32_t there = in.there[i];
    const std::int32_t seen = truth(in.cameras[i] != 0);
    const std::int32_t measured = there & (truth(in.steps[i] > 0.0F) | seen);
    const auto r = std::bit_cast<std::int32_t>(in.steps[i] * steps.residual_m);
    residual[i] = std::bit_cast<float>((r & measured) | (kNaN & ~measured));
    state[i] = (2 & there) + measured;
    measured_count -= measured;
    there_count -= there;
    camera_count -= seen;
  }
  if (out.x != nullptr) {
    const double factor[2] = {std::numeric_limits<double>::quiet_NaN(), steps.coordinate_m};
    double* x = out.x;
    for (std::int64_t i = 0; i < n; ++i, x += 3) {
      const double f = factor[in.there[i] & 1];
      x[0] = in.x[i] * f;
      x[1] = in.y[i] * f;
      x[2] = in.z[i] * f;
    }
  }
  if (out.state != nullptr)
    for (std::int64_t i = 0; i < n; ++i) out.state[i] = static_cast<SampleState>(state[i]);
  if (out.residual != nullptr) std::copy_n(residual, n, out.residual);
  if (out.mask != nullptr)
    for (std::int64_t i = 0; i < n; ++i) out.mask[i] = static_cast<std::uint8_t>(in.cameras[i]);
  total.measured += measured_count;
  total.unmeasured += there_count - measured_count;
  total.with_cameras += camera_count;
}

template <class Samples>
void decode_points(const std::byte* in, std::int64_t points, const Steps& steps, const Cursor& out,
                   Boxes& boxes, C3dSeen& seen) {
  Batch batch;
  const auto at = [](auto* p, std::int64_t i) { return p == nullptr ? nullptr : p + i; };
  for (std::int64_t m = 0; m < points; m += kBatch) {
    const std::int64_t n = std::min(kBatch, points - m);
    Samples::load(in + static_cast<std::size_t>(m) * 4 * Samples::kBytes, n, batch);
    if (out.x != nullptr) boxes.add(batch, n);
    finish(batch, n, steps, {at(out.x, 3 * m), at(out.state, m), at(out.residual, m), at(out.mask, m)}, seen);
  }
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

/// Points that are no markers, in the numbers of the file.
template <class Samples>
void decode_channels(const C3dLayout& layout, const std::byte* in, double* out) {
  const double unit = layout.is_float ? 1.0 : layout.scale;
  for (const std::int64_t point : layout.channel_points) {
    const std::byte* at = in + static_cast<std::size_t>(point) * 4 * Samples::kBytes;
    const double word = Samples::analog(at + 3 * Samples::kBytes, false);
    const bool there = word >= 0.0 && word < 65535.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      *out++ = there ? unit * Samples::analog(at + axis * Samples::kBytes, false)
                     : std::numeric_limits<double>::quiet_NaN();
  }
}

template <class Samples>
C3dSeen decode(const C3dLayout& layout, const std::byte* in, std::int64_t frames, const C3dFrames& out) {
  const auto points = static_cast<std::size_t>(layout.points);
  const auto markers = static_cast<std::size_t>(layout.markers);
  const Steps steps{.coordinate_m = layout.metres_per_unit * (layout.is_float ? 1.0 : layout.scale),
                    .residual_m = static_cast<float>(layout.metres_per_unit * layout.scale)};
  C3dSeen seen;
  Boxes boxes;
  for (std::int64_t f = 0; f < frames; ++f, in += layout.frame_bytes) {
    const auto frame = static_cast<std::size_t>(f);
    const auto at = [&](auto span, std::size_t width) {
      return span.empty() ? nullptr : span.data() + frame * width;
    };
    std::size_t m = 0;
    for (const C3dMarkerRun& run : layout.runs) {
      const auto from = [&](auto span, std::size_t width) {
        return span.empty() ? nullptr : span.data() + (frame * markers + m) * width;
      };
      decode_points<Samples>(
          in + static_cast<std::size_t>(run.first) * 4 * Samples::kBytes, run.count, steps,
          {from(out.x_in_world, 3), from(out.state, 1), from(out.residual_m, 1), from(out.camera_mask, 1)},
          boxes, seen);
      m += static_cast<std::size_t>(run.count);
    }
    if (!out.channels.empty())
      decode_channels<Samples>(layout, in, at(out.channels, 3 * layout.channel_points.size()));
    if (!out.analog.empty())
      decode_analog<Samples>(layout, in + points * 4 * Samples::kBytes,
                             at(out.analog, static_cast<std::size_t>(layout.analog_per_frame())));
  }
  seen.box_m = boxes.metres(steps.coordinate_m);
  return seen;
}

}  // namespace

C3dSeen& C3dSeen::operator+=(const C3dSeen& other) {
  measured += other.measured;
  unmeasured += other.unmeasured;
  with_cameras += other.with_cameras;
  box_m.extend(other.box_m);
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
