// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinemark {

/// `text` without blanks, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trim(std::string_view text);

/// The whole of `text` (blanks around it allowed, a leading + too) as a number, whatever the locale. NaN in
/// any case and with any sign, "inf" and "infinity" are numbers. Nothing, or anything else around it: no
/// value.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Shortest text that reads back as the same double ("nan" for NaN).
[[nodiscard]] std::string format_number(double value);

}  // namespace kinemark
