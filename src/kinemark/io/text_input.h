// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// The whole of a text file with lines (TRC, CSV, tables). One of more than a megabyte is judged by its first
/// before the rest is read: a zero byte, or no end of a line in it, and it is no such text. Code::bad_input
/// then, and for more than `max_bytes`; else as InputFile. What another program or country writes otherwise
/// is brought to one form (text_dialect.h). Memory: the text, twice while that is done.
[[nodiscard]] Result<std::string> read_lines_of_text(const std::filesystem::path& path,
                                                     std::size_t max_bytes = 4UL << 30);

}  // namespace kinemark::io
