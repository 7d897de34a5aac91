// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinemark::io {

/// The same text without lines that hold nothing but blanks, quotes and separators and stand between two rows
/// of as many numbers: what spreadsheets and people leave in the middle of a table, where readers would end
/// it. A text without such a line comes back as it is. O(bytes).
[[nodiscard]] std::string without_blank_rows(std::string text);

}  // namespace kinemark::io
