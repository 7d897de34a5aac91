// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The section of trajectories in a CSV file of Vicon: a line that names it, the rate, names above every third
// column, column names, and from Nexus on a row of units.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/internal/vendor_headers.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;
using Row = std::vector<std::string>;

constexpr std::array<std::string_view, 6> kSections{"trajectories", "devices",  "model outputs",
                                                    "joints",       "segments", "events"};

/// The section that a line begins: its only filled cell is one of the names; empty: none.
std::string section_of(std::string_view line) {
  while (!line.empty() && (line.back() == ',' || is_space(line.back()))) line.remove_suffix(1);
  const std::string word = lower(line);
  return std::ranges::find(kSections, word) == kSections.end() ? std::string() : word;
}

Result<Row> next_row(Lines& lines, std::string_view what) {
  std::string_view line;
  if (!lines.next(line))
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends where {} was expected", lines.number() + 1, what));
  if (auto s = check_header_line(line, lines.number()); !s) return std::unexpected(s.error());
  Row out;
  if (!split_csv(line, out))
    return fail(Code::bad_input, fmt::format("line {}: a quote is not closed", lines.number()));
  return out;
}

/// Up to the line that begins the trajectories.
Status find_trajectories(Lines& lines, data::Trial& trial) {
  std::vector<std::string> others;
  std::string_view line;
  while (lines.next(line)) {
    const std::string section = section_of(line);
    if (section == "trajectories") {
      if (!others.empty())
        trial.warnings.push_back(fmt::format("sections that are not read: {}", join(others)));
      return {};
    }
    if (!section.empty()) others.push_back(section);
  }
  return fail(Code::bad_input, fmt::format("line {}: the file ends without a section of trajectories{}",
                                           lines.number(), others.empty() ? "" : "; it has " + join(others)));
}

/// Cells before the coordinates, by their names.
MarkerColumns::Column lead_column(const std::string& name) {
  const std::string word = lower(name);
  if (word == "frame" || word == "field #" || word == "field") return {.kind = Kind::frame};
  if (word.starts_with("time")) return {.kind = Kind::time};
  return {.kind = Kind::unread};
}

/// What each column is: a name stands above its x.
void lay_out(const Row& names, const Row& axes, MarkerColumns& columns, data::Trial& trial) {
  std::int32_t marker = -1;
  int unread = 0;
  for (std::size_t c = 0; c < axes.size(); ++c) {
    if (c < names.size() && !names[c].empty()) {
      marker = static_cast<std::int32_t>(columns.names.size());
      columns.names.push_back(name_of_bytes(names[c]));
    }
    const std::string& axis = axes[c];
    if (marker < 0) {
      columns.columns.push_back(lead_column(axis));
    } else if (axis == "X" || axis == "Y" || axis == "Z") {
      columns.columns.push_back(
          {.kind = Kind::coordinate, .marker = marker, .axis = static_cast<std::int8_t>(axis[0] - 'X')});
    } else {
      unread += !axis.empty();
      columns.columns.push_back({.kind = Kind::unread});
    }
  }
  if (unread > 0)
    trial.warnings.push_back(
        fmt::format("{} columns of trajectories are not X, Y or Z and are not read", unread));
}

/// A row of units follows where its first number is none.
Status read_units(Lines& lines, MarkerColumns& columns, data::Trial& trial) {
  std::string_view line;
  Lines ahead = lines;
  trial.units_in_file = "mm";
  if (!ahead.next(line)) return {};
  if (auto s = check_header_line(line, ahead.number()); !s) return s;
  Row cells;
  if (is_blank(line) || !split_csv(line, cells)) return {};
  const auto filled = std::ranges::find_if(cells, [](const std::string& c) { return !c.empty(); });
  if (filled == cells.end() || parse_number(*filled)) return {};
  std::string unit;
  for (std::size_t c = 0; c < std::min(cells.size(), columns.columns.size()); ++c)
    if (columns.columns[c].kind == Kind::coordinate && unit.empty()) unit = cells[c];
  const auto per_metre = units_per_metre(unit, ahead.number());
  if (!per_metre) return std::unexpected(per_metre.error());
  columns.units_per_metre = *per_metre;
  trial.units_in_file = lower(unit);
  lines = ahead;
  return {};
}

}  // namespace

Result<VendorHeader> parse_vicon_header(Lines& lines, data::Trial& trial) {
  if (auto s = find_trajectories(lines, trial); !s) return std::unexpected(s.error());
  VendorHeader out;
  out.columns.separator = ',';
  const auto rate_row = next_row(lines, "the frame rate");
  if (!rate_row) return std::unexpected(rate_row.error());
  const auto rate = rate_row->empty() ? std::nullopt : parse_number(rate_row->front());
  if (!rate)
    return fail(Code::bad_input,
                fmt::format("line {}: the frame rate is '{}'; expected a number", lines.number(),
                            rate_row->empty() ? "" : excerpt(rate_row->front())));
  if (auto s = check_rate(*rate, fmt::format("line {}: the frame rate", lines.number())); !s)
    return std::unexpected(s.error());
  out.columns.rates_hz.push_back(*rate);
  const auto names = next_row(lines, "the row of marker names");
  if (!names) return std::unexpected(names.error());
  const std::int64_t names_line = lines.number();
  const auto axes = next_row(lines, "the row of column names");
  if (!axes) return std::unexpected(axes.error());
  lay_out(*names, *axes, out.columns, trial);
  if (out.columns.names.empty())
    return fail(Code::bad_input, fmt::format("line {}: names no marker", names_line));
  if (auto s = read_units(lines, out.columns, trial); !s) return std::unexpected(s.error());
  settle_marker_names(out.columns.names, names_line, trial);
  trial.software = "Vicon";
  return out;
}

}  // namespace kinemark::io::internal
