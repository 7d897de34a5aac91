// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which numbers are frame rates: the same for every file format.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

inline constexpr double kSlowest_hz = 0.001;  ///< a frame in a quarter of an hour
inline constexpr double kFastest_hz = 1e6;    ///< faster than any camera or converter of movement

/// Whether a number can be a frame rate, Hz: not NaN, zero, negative or beyond the bounds above.
[[nodiscard]] constexpr bool is_rate(double rate_hz) {
  return rate_hz >= kSlowest_hz && rate_hz <= kFastest_hz;
}

/// Code::bad_input for anything that is_rate() does not hold of. `where`: what states it, "POINT:RATE".
[[nodiscard]] Status check_rate(double rate_hz, std::string_view where);

/// Whether a file states its rate, where it has another way to tell it. Programs write 0 for a rate that they
/// do not know: false, which is said among the warnings. Anything else as check_rate().
[[nodiscard]] Result<bool> states_rate(double rate_hz, std::string_view where,
                                       std::vector<std::string>& warnings);

}  // namespace kinemark::io
