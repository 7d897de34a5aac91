// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinemark::stream {

/// CRC-16 with polynomial 0x1021, most significant bit first, begun with 0xFFFF ("CCITT-FALSE"): 0x29B1 for
/// "123456789". Finds all errors within 16 neighbouring bits.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

}  // namespace kinemark::stream
