// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/frame_decoder.h"

#include <algorithm>

#include "kinemark/core/check.h"
#include "kinemark/stream/serial/check_sum.h"

namespace kinemark::stream {
namespace {

// A number farther ahead than this is no loss: 4 hours at 1 kHz.
constexpr std::uint32_t kFarthest = 1U << 24;

std::uint32_t read_u32(const std::uint8_t* at) {
  return at[0] | static_cast<std::uint32_t>(at[1]) << 8 | static_cast<std::uint32_t>(at[2]) << 16 |
         static_cast<std::uint32_t>(at[3]) << 24;
}

/// Four counts of 10 bits in 5 bytes, low bits first.
void unpack(const std::uint8_t* at, std::int16_t* out) {
  for (int k = 0; k < 4; ++k)
    out[k] = static_cast<std::int16_t>((at[k] >> (2 * k) | at[k + 1] << (8 - 2 * k)) & 0x3FF);
}

}  // namespace

FrameDecoder::FrameDecoder(FrameShape shape) : shape_(shape) {
  check(shape.slots >= 1 && shape.slots <= 255 && shape.cameras >= 1 && shape.cameras <= 255,
        "a frame has 1 to 255 slots and cameras");
}

void FrameDecoder::push(std::span<const std::uint8_t> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

/// Whether a frame can begin here, as far as its first bytes are known.
bool FrameDecoder::can_begin(std::size_t at) const {
  const std::uint8_t head[] = {kFrameStart1, kFrameStart2, static_cast<std::uint8_t>(shape_.slots),
                               static_cast<std::uint8_t>(shape_.cameras)};
  const std::size_t known = std::min(std::size(head), bytes_.size() - at);
  return std::equal(head, head + known, bytes_.begin() + static_cast<std::ptrdiff_t>(at));
}

bool FrameDecoder::accept(std::size_t at, SerialFrame& frame) {
  const std::uint8_t* head = bytes_.data() + at;
  const auto ahead = read_u32(head + 4) - static_cast<std::uint32_t>(expected_);
  if (ahead > kFarthest) {
    ++losses_.refused;
    return false;
  }
  losses_.lost += ahead;
  frame.number = expected_ + ahead;
  expected_ = frame.number + 1;
  const auto dropped = read_u32(head + 8);
  losses_.by_device += dropped - dropped_;
  dropped_ = dropped;
  frame.dropped = losses_.by_device;
  const std::size_t cells = static_cast<std::size_t>(shape_.slots) * static_cast<std::size_t>(shape_.cameras);
  frame.counts.resize(4 * cells);
  for (std::size_t i = 0; i < cells; ++i) unpack(head + kFrameHead + 5 * i, frame.counts.data() + 4 * i);
  return true;
}

bool FrameDecoder::next(SerialFrame& frame) {
  const std::size_t size = shape_.bytes();
  while (at_ < bytes_.size()) {
    if (!can_begin(at_)) {
      ++at_;
      ++losses_.stray;
      continue;
    }
    if (bytes_.size() - at_ < size) return false;
    const std::span whole(bytes_.data() + at_, size);
    const unsigned check = whole[size - 2] | static_cast<unsigned>(whole[size - 1]) << 8;
    if (crc16(whole.subspan(2, size - 4)) != check) {
      ++at_;
      ++losses_.stray;
      continue;
    }
    const bool accepted = accept(at_, frame);
    at_ += size;
    if (accepted) return true;
  }
  return false;
}

}  // namespace kinemark::stream
