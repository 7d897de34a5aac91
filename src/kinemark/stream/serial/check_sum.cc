// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/check_sum.h"

#include <array>

namespace kinemark::stream {
namespace {

consteval std::array<std::uint16_t, 256> make_table() {
  std::array<std::uint16_t, 256> out{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned crc = i << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1;
    out[i] = static_cast<std::uint16_t>(crc);
  }
  return out;
}
constexpr auto kTable = make_table();

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFFFF;
  for (const unsigned byte : bytes) crc = (crc << 8 & 0xFFFF) ^ kTable[(crc >> 8 ^ byte) & 0xFF];
  return static_cast<std::uint16_t>(crc);
}

}  // namespace kinemark::stream
