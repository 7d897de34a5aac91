// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/testing/rig_bytes.h"

#include <cstddef>

namespace kinemark::stream::testing {
namespace {

void put(Bytes& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// Bit by bit, as a textbook has it.
std::uint32_t check_of(const Bytes& bytes, std::size_t from) {
  std::uint32_t crc = 0xFFFF;
  for (std::size_t i = from; i < bytes.size(); ++i)
    for (int bit = 7; bit >= 0; --bit) {
      const std::uint32_t in = (bytes[i] >> bit & 1U) ^ (crc >> 15 & 1U);
      crc = (crc << 1 & 0xFFFF) ^ (in != 0 ? 0x1021U : 0U);
    }
  return crc;
}

}  // namespace

Bytes frame_bytes(int slots, int cameras, std::uint32_t sequence, std::uint32_t dropped,
                  std::span<const std::int16_t> counts) {
  Bytes out{0xA5, 0x5A, static_cast<std::uint8_t>(slots), static_cast<std::uint8_t>(cameras)};
  put(out, sequence, 4);
  put(out, dropped, 4);
  // A row of bits, low ones first.
  Bytes bits;
  for (const std::int16_t count : counts)
    for (int bit = 0; bit < 10; ++bit) bits.push_back(static_cast<std::uint8_t>(count >> bit & 1));
  for (std::size_t i = 0; i < bits.size(); i += 8) {
    std::uint32_t byte = 0;
    for (std::size_t bit = 0; bit < 8; ++bit) byte |= static_cast<std::uint32_t>(bits[i + bit]) << bit;
    put(out, byte, 1);
  }
  put(out, check_of(out, 2), 2);
  return out;
}

std::vector<std::int16_t> telling_counts(int slots, int cameras, std::uint32_t sequence) {
  std::vector<std::int16_t> out(static_cast<std::size_t>(slots) * static_cast<std::size_t>(cameras) * 4);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::int16_t>((sequence * 131 + i * 257 + 7) % 1024);
  return out;
}

Bytes telling_frame(int slots, int cameras, std::uint32_t sequence, std::uint32_t dropped) {
  return frame_bytes(slots, cameras, sequence, dropped, telling_counts(slots, cameras, sequence));
}

}  // namespace kinemark::stream::testing
