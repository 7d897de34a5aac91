// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/analog_format.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "kinemark/core/array.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kBufferBytes = 512UL << 10;
constexpr int kRange = 65536;
constexpr int kJump = kRange / 4 * 3;  // between neighbours: a step through nearly the whole range
constexpr int kAround = 8;  // a step that goes on is at most so often the smaller of those beside it
constexpr std::uint64_t kSignOfSecond = std::uint64_t{0x8000} << 32;
constexpr std::int64_t kLeastJumps = 4;  // fewer may be single wrong samples

/// Steps of one channel through nearly the whole range in one reading.
struct Jumps {
  std::int64_t all = 0;
  std::int64_t closed = 0;  ///< of these, steps that go on from those beside them in the other reading
};
struct ChannelJumps {
  Jumps as_signed, as_unsigned;
  std::uint64_t latest = 0;  ///< four samples of 16 bits, the last one lowest
};

/// The step from sample `at` of the four to the next, 0 the oldest.
int step(std::uint64_t latest, int at, bool is_unsigned) {
  const auto number = [&](int k) -> int {
    const auto word = static_cast<std::uint16_t>(latest >> (16 * (3 - k)));
    return is_unsigned ? word : static_cast<std::int16_t>(word);
  };
  return std::abs(number(at + 1) - number(at));
}

/// Counts the step from the second to the third of four samples, which lie on both sides of the sign: only
/// then is it one through nearly the whole range, in one reading alone.
void count_middle(ChannelJumps& channel) {
  const int as_unsigned = step(channel.latest, 1, true);
  const bool jumps_signed = kRange - as_unsigned > kJump;
  if (as_unsigned <= kJump && !jumps_signed) return;
  // In the reading in which it is small.
  const int small = step(channel.latest, 1, jumps_signed);
  const int beside = std::min(step(channel.latest, 0, jumps_signed), step(channel.latest, 2, jumps_signed));
  // From one end of the range to the other, where it stays, or one that nearly rests in the middle of it.
  if (small == 1 && beside == 0) return;
  Jumps& jumps = jumps_signed ? channel.as_signed : channel.as_unsigned;
  ++jumps.all;
  jumps.closed += small <= kAround * beside;
}

/// Jumps of each channel.
Result<std::vector<ChannelJumps>> count_jumps(const ByteSource& source, const C3dLayout& layout) {
  std::vector<ChannelJumps> out(static_cast<std::size_t>(layout.analog_channels));
  const auto block = static_cast<std::int64_t>(std::max<std::size_t>(1, kBufferBytes / layout.frame_bytes));
  Array<std::byte> buffer(static_cast<std::size_t>(std::min(block, layout.frames)) * layout.frame_bytes);
  std::int64_t sample = 0;
  const std::size_t first = 8 * static_cast<std::size_t>(layout.points);
  for (std::int64_t f = 0; f < layout.frames; f += block) {
    const auto frames = static_cast<std::size_t>(std::min(block, layout.frames - f));
    const auto bytes = std::span(buffer).first(frames * layout.frame_bytes);
    const auto n =
        source.read_at(layout.data_offset + static_cast<std::size_t>(f) * layout.frame_bytes, bytes);
    if (!n) return std::unexpected(n.error());
    if (*n < bytes.size())
      return fail(Code::io, fmt::format("{}: became shorter while it was read", source.name()));
    for (std::size_t frame = 0; frame < frames; ++frame) {
      const std::byte* at = bytes.data() + frame * layout.frame_bytes + first;
      for (std::int64_t s = 0; s < layout.samples_per_frame; ++s, ++sample)
        for (ChannelJumps& channel : out) {
          channel.latest = channel.latest << 16 | load_u16(at, layout.processor);
          if (sample >= 3 && ((channel.latest ^ channel.latest << 16) & kSignOfSecond) != 0)
            count_middle(channel);
          at += 2;
        }
    }
  }
  return out;
}

/// The other reading: numbers of the file that are offsets change with it.
void exchange_reading(const C3dParameters& parameters, C3dLayout& layout) {
  layout.analog_unsigned = !layout.analog_unsigned;
  const C3dParameter* offset = parameters.find("ANALOG", "OFFSET");
  if (offset == nullptr || offset->type != C3dType::int16) return;
  for (double& o : layout.analog_offset) {
    if (layout.analog_unsigned && o < 0.0) o += kRange;
    if (!layout.analog_unsigned && o > 32767.0) o -= kRange;
  }
}

}  // namespace

Status settle_analog_format(const ByteSource& source, const C3dParameters& parameters,
                            const std::vector<std::string>& names, C3dLayout& layout,
                            std::vector<std::string>& warnings) {
  const double bits = parameters.number("ANALOG", "BITS").value_or(16.0);
  if (layout.is_float || layout.analog_per_frame() == 0 || (bits > 0.0 && bits < 16.0)) return {};
  const auto channels = count_jumps(source, layout);
  if (!channels) return std::unexpected(channels.error());
  const auto stated = layout.analog_unsigned ? &ChannelJumps::as_unsigned : &ChannelJumps::as_signed;
  const auto other = layout.analog_unsigned ? &ChannelJumps::as_signed : &ChannelJumps::as_unsigned;
  Jumps here, there;
  std::vector<std::string> jumping;
  for (std::size_t c = 0; c < channels->size(); ++c) {
    const Jumps &mine = (*channels)[c].*stated, &others = (*channels)[c].*other;
    here.all += mine.all;
    here.closed += mine.closed;
    there.all += others.all;
    there.closed += others.closed;
    if (mine.all > 0) jumping.push_back(c < names.size() ? names[c] : fmt::to_string(c + 1));
  }
  // A reading is taken that joins most jumps of the other, which joins next to none of its own.
  if (here.closed < kLeastJumps || 2 * here.closed < here.all || 100 * there.closed > here.closed) return {};
  const auto word = [](bool is_unsigned) { return is_unsigned ? "unsigned" : "signed"; };
  const bool was = layout.analog_unsigned;
  exchange_reading(parameters, layout);
  const std::string format = parameters.text("ANALOG", "FORMAT");
  warnings.push_back(fmt::format(
      "ANALOG:FORMAT {}, but the 16-bit samples are {} and read as such: as {} ones {} ({}) by nearly the "
      "whole range {} times from one sample to the next, as {} ones {}",
      format.empty() ? "is missing" : fmt::format("says '{}'", printable(format, 20)), word(!was), word(was),
      jumping.size() == 1 ? "1 channel jumps" : fmt::format("{} channels jump", jumping.size()),
      join_some(jumping, 3), here.all, word(!was),
      there.all == 0 ? "never" : fmt::format("{} times", there.all)));
  return {};
}

}  // namespace kinemark::io
