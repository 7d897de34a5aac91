// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tables for statistics: one observation a line, its attributes in named columns; or plain numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// R rows and K columns of text, as written.
struct TidyTable {
  std::string name;                   ///< of the file, for messages
  std::vector<std::string> columns;   ///< K names, unique; empty: the file has no line of names
  std::int64_t width = 0;             ///< K
  std::vector<std::string> cells;     ///< R x K, row first, without blanks at their ends
  std::vector<std::int64_t> line_of;  ///< R, line of each row in the file, from 1

  /// R.
  [[nodiscard]] std::int64_t rows() const { return std::ssize(line_of); }
  /// Index of a column, or -1.
  [[nodiscard]] std::int64_t find(std::string_view column) const;
  /// A cell.
  [[nodiscard]] const std::string& operator()(std::int64_t row, std::int64_t column) const {
    return cells[static_cast<std::size_t>(row * width + column)];
  }
  /// A cell as a number: NaN where it is blank or says so; Code::bad_input, with file, line and column, for
  /// other text and infinity.
  [[nodiscard]] Result<double> number(std::int64_t row, std::int64_t column) const;
};

/// Whether a spreadsheet would take the text for a formula, were it not for apostrophes before it: after any
/// number of these it begins with =, +, - or @.
[[nodiscard]] bool is_like_formula(std::string_view text);

/// Read comma-separated values (RFC 4180; semicolons, tabs or blanks where there is no comma in the first
/// line). A first line of numbers alone is a row: the file has no names. Blank lines and lines that begin
/// with # are passed over. An apostrophe that keeps a text from being taken for a formula (is_like_formula())
/// is taken off. Code::bad_input, with the line, for a row of another width, a quote that is not closed, a
/// column that occurs twice or has no name, and a file without rows; Code::io as InputFile. Memory: 40 bytes
/// a cell beside the text.
[[nodiscard]] Result<TidyTable> read_tidy_csv(const std::filesystem::path& path);
/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<TidyTable> parse_tidy_csv(std::string_view text, const std::string& name);

}  // namespace kinemark::io
