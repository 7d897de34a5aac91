// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

constexpr std::int64_t kMostColumns = 100'000;

// What separates cells: the first of these that the first line holds, blanks where there is none.
char separator_of(std::string_view line) {
  for (const char c : {',', ';', '\t'})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

bool split(std::string_view line, char separator, std::vector<std::string>& cells) {
  if (separator == ',') return internal::split_csv(line, cells);
  cells.clear();
  if (separator == ' ') {
    for (std::size_t begin = line.find_first_not_of(' '); begin < line.size();) {
      const auto end = std::min(line.find(' ', begin), line.size());
      cells.emplace_back(line.substr(begin, end - begin));
      begin = line.find_first_not_of(' ', end);
    }
    return true;
  }
  for (std::size_t begin = 0; begin <= line.size();) {
    const auto end = std::min(line.find(separator, begin), line.size());
    cells.emplace_back(trim(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return true;
}

bool is_row_of_numbers(const std::vector<std::string>& cells) {
  return std::ranges::all_of(cells, [](const std::string& cell) { return parse_number(cell).has_value(); });
}

Status take_names(std::vector<std::string>& cells, TidyTable& table) {
  std::set<std::string> seen;
  for (std::string& cell : cells) {
    std::string name = name_of_bytes(cell);
    if (name.empty())
      return fail(Code::bad_input, fmt::format("column {} of the first line has no name", seen.size() + 1));
    if (!seen.insert(name).second)
      return fail(Code::bad_input, fmt::format("column '{}' occurs twice", internal::excerpt(name)));
    table.columns.push_back(std::move(name));
  }
  return {};
}

Status parse_rows(std::string_view text, TidyTable& table) {
  internal::Lines lines(text);
  std::string_view line;
  std::vector<std::string> cells;
  char separator = ',';
  while (lines.next(line)) {
    if (internal::is_blank(line) || line.front() == '#') continue;
    const bool is_first = table.width == 0;
    const auto wrong = [&](const std::string& what) {
      return fail(Code::bad_input, fmt::format("line {}: {}", lines.number(), what));
    };
    if (is_first) {
      if (auto s = internal::check_header_line(line, lines.number()); !s) return s;
      separator = separator_of(line);
    }
    if (!split(line, separator, cells)) return wrong("a quote is not closed");
    for (std::string& cell : cells)
      if (cell.starts_with('\'') && is_like_formula(cell)) cell.erase(0, 1);
    if (is_first) {
      table.width = std::ssize(cells);
      if (table.width > kMostColumns) return wrong(fmt::format("has more than {} columns", kMostColumns));
      if (!is_row_of_numbers(cells)) {
        if (auto s = take_names(cells, table); !s) return wrong(s.error().message);
        continue;
      }
    }
    if (std::ssize(cells) != table.width)
      return wrong(fmt::format("has {} cells; the first line has {}", cells.size(), table.width));
    std::ranges::move(cells, std::back_inserter(table.cells));
    table.line_of.push_back(lines.number());
  }
  if (table.width == 0) return fail(Code::bad_input, "is empty; expected comma-separated values");
  if (table.rows() == 0) return fail(Code::bad_input, "has a line of names and no row");
  return {};
}

}  // namespace

bool is_like_formula(std::string_view text) {
  const auto first = text.find_first_not_of('\'');
  return first != std::string_view::npos && std::string_view("=+-@").contains(text[first]);
}

std::int64_t TidyTable::find(std::string_view column) const {
  const auto at = std::ranges::find(columns, column);
  return at == columns.end() ? -1 : at - columns.begin();
}

Result<double> TidyTable::number(std::int64_t row, std::int64_t column) const {
  const std::string& cell = (*this)(row, column);
  if (cell.empty()) return kNaN;
  const auto value = parse_number(cell);
  if (value && !std::isinf(*value)) return *value;
  const auto at = static_cast<std::size_t>(column);
  const std::string where =
      columns.empty() ? fmt::format("column {}", column + 1) : fmt::format("column '{}'", columns[at]);
  return fail(Code::bad_input,
              fmt::format("{}: line {}: {} is '{}'; need a number", name,
                          line_of[static_cast<std::size_t>(row)], where, internal::excerpt(cell)));
}

Result<TidyTable> parse_tidy_csv(std::string_view text, const std::string& name) {
  TidyTable table;
  table.name = name;
  if (auto s = parse_rows(text, table); !s) return fail_at(name, s.error());
  return table;
}

Result<TidyTable> read_tidy_csv(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_tidy_csv(*text, path.string());
}

}  // namespace kinemark::io
