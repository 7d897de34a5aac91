// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/blank_rows.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "kinemark/core/number.h"

namespace kinemark::io {
namespace {

constexpr std::string_view kSeparators = ",;\t";
constexpr std::string_view kNothing = ",;\t \"\r\v\f";

bool is_blank_row(std::string_view line) {
  return line.find_first_not_of(kNothing) == std::string_view::npos;
}

/// Cells of a row that begins with a number and holds nothing else; 0 of any other line.
std::size_t numbers_in(std::string_view line) {
  std::size_t cells = 0, numbers = 0;
  for (std::size_t at = 0; at <= line.size(); ++cells) {
    const auto end = std::min(line.find_first_of(kSeparators, at), line.size());
    auto cell = trim(line.substr(at, end - at));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    const bool is_number = parse_number(cell).has_value();
    if (!cell.empty() && !is_number) return 0;
    if (cells == 0 && !is_number) return 0;
    numbers += is_number ? 1 : 0;
    at = end + 1;
  }
  return numbers >= 2 ? cells : 0;
}

/// The line that begins at `at`, and where the next one does.
std::string_view line_at(std::string_view text, std::size_t at, std::size_t& next) {
  const auto end = std::min(text.find('\n', at), text.size());
  next = std::min(end + 1, text.size());
  return text.substr(at, end - at);
}

}  // namespace

std::string without_blank_rows(std::string text) {
  std::string out;
  std::size_t copied = 0;  // bytes
  std::string_view above;  // the line before
  for (std::size_t at = 0, next = 0; at < text.size(); at = next) {
    const auto line = line_at(text, at, next);
    if (!is_blank_row(line)) {
      above = line;
      continue;
    }
    std::size_t after = next, end = next;
    std::string_view row;
    while (after < text.size() && is_blank_row(row = line_at(text, after, end))) after = end;
    const auto cells = after < text.size() ? numbers_in(above) : 0;
    if (cells > 0 && numbers_in(row) == cells) {
      out.append(text, copied, at - copied);
      copied = after;
    }
    next = after;
  }
  if (copied == 0) return text;
  return out.append(text, copied);
}

}  // namespace kinemark::io
