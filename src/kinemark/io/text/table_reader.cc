// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/io/seal.h"
#include "kinemark/io/text/internal/any_table.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/table_header.h"
#include "kinemark/io/text/internal/table_values.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::Cell;
using internal::Cells;
using internal::excerpt;
using internal::Lines;
using internal::Separator;
using internal::TableHeader;

std::unexpected<Error> bad_cell(std::int64_t line, std::size_t column, std::string_view label,
                                std::string_view cell, std::string_view expected) {
  return fail(
      Code::bad_input,
      fmt::format("line {}, column {} ({}): {}; expected {}", line, column, excerpt(label),
                  cell.empty() ? "the cell is blank" : fmt::format("found '{}'", excerpt(cell)), expected));
}

/// Split "1,2,3" into `width` numbers.
bool read_tuple(std::string_view cell, std::size_t width, double* out) {
  for (std::size_t k = 0; k < width; ++k) {
    const std::size_t comma = k + 1 < width ? cell.find(',') : cell.size();
    if (comma == std::string_view::npos || !internal::parse_odd_number(cell.substr(0, comma), out[k]))
      return false;
    cell.remove_prefix(std::min(comma + 1, cell.size()));
  }
  return true;
}

/// The cells after time; `out` has room for all of them.
Status read_values(Cells& cells, std::int64_t line, const TableHeader& header, double* out) {
  const std::size_t cells_expected = header.columns_named.size() / header.width;
  std::size_t found = 0;
  for (; found < cells_expected; ++found) {
    double* value = out + found * header.width;
    const std::string& label = header.columns_named[found * header.width];
    if (header.width > 1) {
      std::string_view cell;
      if (!cells.next_text(cell)) break;
      if (!read_tuple(cell, header.width, value))
        return bad_cell(line, found + 2, label, cell,
                        fmt::format("{} numbers with commas between", header.width));
      continue;
    }
    const Cell kind = cells.next(*value);
    if (kind == Cell::none) break;
    if (kind == Cell::blank) *value = std::numeric_limits<double>::quiet_NaN();
    if (kind == Cell::text) return bad_cell(line, found + 2, label, cells.text(), "a number");
  }
  std::size_t more = 0;
  for (std::string_view cell; cells.next_text(cell);) more += cell.empty() ? 0 : 1;
  if (found == cells_expected && more == 0) return {};
  return fail(Code::bad_input, fmt::format("line {}: holds {} cells where {} columns are labelled", line,
                                           1 + found + more, 1 + cells_expected));
}

Result<data::Table> parse_rows(std::string_view text, bool orientations) {
  Lines lines(text);
  auto header = internal::parse_table_header(lines);
  if (!header) return std::unexpected(header.error());
  if (header->is_orientations && !orientations)
    return fail(Code::not_supported,
                "holds orientations, as of inertial sensors (DataType=Quaternion); 'kinemark ik "
                "--orientations' reads them; expected coordinates (double) or markers (Vec3)");
  if (!header->is_orientations && orientations)
    return fail(Code::bad_input, "holds no orientations; expected DataType=Quaternion");
  const auto rows = static_cast<std::size_t>(lines.count_until_blank());
  const std::size_t columns = header->columns_named.size();
  // Each number takes a byte at least, so a text cannot ask for more than this; checked before allocating.
  if (columns > 0 && rows > text.size() / columns)
    return fail(Code::bad_input,
                fmt::format("line {}: {} rows of {} columns do not fit into the {} bytes of this file",
                            lines.number() + 1, rows, columns, text.size()));
  data::Table table;
  table.name = header->name;
  table.header = header->pairs;
  table.degrees_stated = header->in_degrees.has_value();
  table.in_degrees = header->in_degrees.value_or(false);
  table.warnings = header->warnings;
  table.time_s.reserve(rows);
  table.values.resize(rows * columns);

  std::size_t repeated = 0;
  std::int64_t first_repeated = 0;
  std::vector<std::int64_t> line_of_row;
  line_of_row.reserve(rows);
  std::string_view line;
  for (std::size_t row = 0; row < rows; ++row) {
    lines.next(line);
    // Files edited by hand hold rows in blanks under labels in tabs. A vector may hold blanks: "1, 2, 3".
    const bool mixed = header->width == 1 && columns > 0;
    Cells cells(line, mixed ? internal::separator_of_row(line, header->separator) : header->separator);
    double time_s = 0.0;
    if (cells.next(time_s) != Cell::number || !std::isfinite(time_s))
      return bad_cell(lines.number(), 1, "time", cells.text(), "a number");
    if (auto status =
            read_values(cells, lines.number(), *header, table.values.data() + table.time_s.size() * columns);
        !status)
      return std::unexpected(status.error());
    if (!table.time_s.empty() && time_s < table.time_s.back())
      return fail(Code::bad_input, fmt::format("line {} (row {}): time runs backwards from {} to {} s",
                                               lines.number(), row + 1, table.time_s.back(), time_s));
    if (!table.time_s.empty() && time_s == table.time_s.back()) {
      if (repeated++ == 0) first_repeated = lines.number();
    } else {
      table.time_s.push_back(time_s);
      line_of_row.push_back(lines.number());
    }
  }
  table.values.resize(table.time_s.size() * columns);
  table.columns = std::move(header->columns_named);

  if (header->rows && *header->rows != static_cast<double>(rows))
    table.warnings.push_back(
        fmt::format("header says {} rows, {} are there; the rows are used", *header->rows, rows));
  if (repeated > table.time_s.size())
    return fail(
        Code::bad_input,
        fmt::format("line {}: time stands still here and in {} of {} rows in all; times must increase",
                    first_repeated, repeated, rows));
  if (repeated > 0)
    table.warnings.push_back(
        fmt::format("{} rows repeat the time of the row before and are left out", repeated));
  internal::note_jump(
      {.time_s = table.time_s,
       .resolution_s = 0.0,
       .stated = {},
       .most_frames = 0,
       .place = [&](std::size_t row) { return fmt::format("line {} (row {})", line_of_row[row], row + 1); }},
      table.warnings);
  internal::note_absurd_values(table, line_of_row, table.warnings);
  while (lines.next(line)) {
    if (internal::is_blank(line)) continue;
    table.warnings.push_back(
        fmt::format("a blank line ends the data; line {} and what follows is not read", lines.number()));
    break;
  }
  return table;
}

}  // namespace

namespace internal {

Result<data::Table> parse_table(std::string_view text, std::string_view name, bool orientations) {
  auto table = parse_rows(text, orientations);
  if (!table) return fail_at(name, table.error());
  if (check_seal(text) == Seal::broken) table->warnings.push_back(broken_seal());
  return table;
}

}  // namespace internal

Result<data::Table> parse_table(std::string_view text, std::string_view name) {
  return internal::parse_table(text, name, false);
}

Result<data::Table> read_table(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_table(*text, path.string());
}

bool angles_are_degrees(const data::Table& table) {
  if (table.degrees_stated) return table.in_degrees;
  return std::ranges::any_of(table.header, [](const auto& pair) {
    const std::string key = internal::lower(pair.first);
    return key == "datacolumns" || key == "datarows";
  });
}

}  // namespace kinemark::io
