// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>

namespace kinemark::report::internal {

/// RFC 4648 section 4, with padding.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// Base64 of the values' four bytes each, lowest first.
[[nodiscard]] std::string base64(std::span<const float> values);

}  // namespace kinemark::report::internal
