// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace kinemark::io {

/// An instant as clocks and calendars write it.
struct ClockTime {
  std::int64_t day = 0;       ///< from 1970-01-01; 0 where no date is stated
  double second = 0.0;        ///< of the day; below 0 or above 86400 where a time zone moves it there
  double resolution_s = 1.0;  ///< of the last digit that is written
};

/// "2024-05-01T10:00:00.010", with a blank for the T, slashes in the date, "Z" or "+02:00" at its end;
/// "10:00:00.010" without a date; "01:23.456" of minutes and seconds. Seconds may have a decimal comma.
/// Nothing for anything else.
[[nodiscard]] std::optional<ClockTime> parse_clock_time(std::string_view text);

}  // namespace kinemark::io
