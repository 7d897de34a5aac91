// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// For tests: packed blocks read back, as the page does it, but written on its own.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kinemark::report::internal {

/// Bytes of a base64 text that holds a zlib stream; throws where it is damaged.
[[nodiscard]] std::vector<std::uint8_t> inflate_base64(const std::string& text);

/// Numbers of pack_series(), series after series.
[[nodiscard]] std::vector<double> unpack_series(const nlohmann::ordered_json& packed);

/// Numbers of pack_curve(); NaN where there is none.
[[nodiscard]] std::vector<double> unpack_curve(const nlohmann::ordered_json& packed);

/// Codes of pack_codes().
[[nodiscard]] std::vector<std::uint8_t> unpack_codes(const nlohmann::ordered_json& packed);

}  // namespace kinemark::report::internal
