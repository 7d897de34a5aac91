// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/cells.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "kinemark/core/number.h"

namespace kinemark::io::internal {

Lines::Lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  p_ = text.data();
  end_ = text.data() + text.size();
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos)
    line_end_ = '\r';
}

std::int64_t Lines::count_until_blank() const {
  Lines ahead = *this;
  std::string_view line;
  std::int64_t count = 0;
  while (ahead.next(line) && !is_blank(line)) ++count;
  return count;
}

std::int64_t Lines::skip_blank() {
  std::string_view line;
  while (next(line))
    if (!is_blank(line)) return number();
  return 0;
}

Status check_header_line(std::string_view line, std::int64_t number) {
  constexpr std::size_t kMost = 1 << 20;
  if (line.size() <= kMost) return {};
  return fail(Code::bad_input, fmt::format("line {}: has {} bytes; expected a header line of at most {}",
                                           number, line.size(), kMost));
}

bool parse_odd_number(std::string_view cell, double& value) {
  if (const auto number = parse_number(cell)) {
    value = *number;
    return true;
  }
  // What pandas, R and spreadsheets write for a number that is not there.
  constexpr std::array<std::string_view, 10> kAbsent{"NA",   "N/A",  "n/a",  "#N/A", "#NA",
                                                     "<NA>", "None", "NULL", "null", "-"};
  if (std::ranges::find(kAbsent, cell) != kAbsent.end()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  std::string_view digits = cell;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  if (!digits.starts_with("1.#")) return false;
  digits.remove_prefix(3);
  // The precision asked of the printer pads the word with zeros.
  while (digits.ends_with('0')) digits.remove_suffix(1);
  if (digits == "QNAN" || digits == "SNAN" || digits == "IND")
    value = std::numeric_limits<double>::quiet_NaN();
  else if (digits == "INF")
    value = negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  else
    return false;
  return true;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string excerpt(std::string_view cell) {
  constexpr std::size_t kMost = 40;
  std::string out(cell.substr(0, kMost));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return cell.size() > kMost ? out + "..." : out;
}

Separator separator_of_row(std::string_view row, Separator usual) {
  if (usual == Separator::blanks || row.find('\t') == std::string_view::npos) return Separator::blanks;
  const auto is_gap = [](char c) { return is_space(c) || c == '\t'; };
  for (auto at = row.find(' '); at != std::string_view::npos; at = row.find(' ', at)) {
    const bool after_cell = at > 0 && !is_gap(row[at - 1]);
    while (at < row.size() && row[at] == ' ') ++at;
    if (after_cell && at < row.size() && !is_gap(row[at])) return Separator::blanks;
  }
  return usual;
}

bool Cells::next_text(std::string_view& text) {
  if (!begin_cell()) return false;
  const char* first = p_;
  while (p_ != end_ && *p_ != '\t' && (tabs_ || !is_space(*p_))) ++p_;
  text_ = trim(std::string_view(first, static_cast<std::size_t>(p_ - first)));
  finish_cell();
  text = text_;
  return true;
}

Cell Cells::next_odd(double& value) {
  std::string_view cell;
  next_text(cell);
  return parse_odd_number(cell, value) ? Cell::number : Cell::text;
}

}  // namespace kinemark::io::internal
