// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Arrays of a page, packed: what moves little from point to point takes little room.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace kinemark::report::internal {

/// Base64 of a zlib stream of the bytes; the browser's "deflate" reads it.
[[nodiscard]] std::string deflated(std::span<const std::uint8_t> bytes);

/// PackedSeries of docs/formats/pages.md: numbers of series of one length.
///
/// @param values      series after series, each of `points` numbers; NaN where there is none, which reads
/// back
///                    as the number before it (the first number for those ahead of it; 0 without any)
/// @param points      >= 0; values.size() is a multiple of it
/// @param finest      the numbers are rounded to multiples of this or more; > 0
/// @param coarsest    the coarsest rounding; where 65,535 steps of it do not reach, the block is float32
[[nodiscard]] nlohmann::ordered_json pack_series(std::span<const double> values, std::int64_t points,
                                                 double finest, double coarsest);

}  // namespace kinemark::report::internal
