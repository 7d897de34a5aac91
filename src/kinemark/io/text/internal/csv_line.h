// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinemark::io::internal {

/// Cells of a line of comma-separated values (RFC 4180), blanks at their ends taken away; quotes around one
/// may hold commas and blanks, and two quotes stand for one. False: a quote is open at the end of the line.
[[nodiscard]] bool split_csv(std::string_view line, std::vector<std::string>& cells);

}  // namespace kinemark::io::internal
