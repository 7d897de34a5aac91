// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The header of a CSV file of OptiTrack Motive: a line of keys and values, then rows that are found by what
// they hold, as their number depends on the format's version: Type, Name, ID, Parent, Position, and X, Y, Z.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
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

constexpr int kMostMotiveRows = 12;

std::string cell(const Row& row, std::size_t i) { return i < row.size() ? row[i] : std::string(); }

Status bad(std::int64_t line, std::string_view what) {
  return fail(Code::bad_input, fmt::format("line {}: {}", line, what));
}

Result<Row> split(std::string_view line, std::int64_t number) {
  if (auto s = check_header_line(line, number); !s) return std::unexpected(s.error());
  Row out;
  if (!split_csv(line, out))
    return fail(Code::bad_input, fmt::format("line {}: a quote is not closed", number));
  return out;
}

bool holds(const Row& row, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(
      row, [&](const std::string& c) { return std::ranges::find(words, c) != words.end(); });
}

/// Up to the row that begins with "Frame".
Result<MotiveRows> read_rows(Lines& lines) {
  MotiveRows out;
  bool name_is_next = false;
  std::string_view line;
  for (int i = 0; i < kMostMotiveRows && lines.next(line); ++i) {
    auto row = split(line, lines.number());
    if (!row) return std::unexpected(row.error());
    const bool named = cell(*row, 0) == "Name" || cell(*row, 1) == "Name";
    if (cell(*row, 0) == "Frame") {
      out.axis = std::move(*row);
      return out;
    }
    if (out.name.empty() && (named || (name_is_next && !is_blank(line)))) {
      out.name = std::move(*row);
      out.name_line = lines.number();
    } else if (out.type.empty() &&
               holds(*row, {"Marker", "Rigid Body", "Bone", "Rigid Body Marker", "Bone Marker"})) {
      out.type = std::move(*row);
      name_is_next = true;
    } else if (holds(*row, {"Position", "Rotation"})) {
      out.component = std::move(*row);
    }
  }
  return fail(Code::bad_input,
              fmt::format("line {}: the row that begins with Frame is not found; expected it after "
                          "the rows Type, Name, ID and Position",
                          lines.number()));
}

/// Line 1: keys and values side by side.
Status read_keys(const Row& row, std::int64_t line, MarkerColumns& columns, data::Trial& trial) {
  bool has_unit = false;
  for (std::size_t i = 0; i + 1 < row.size(); i += 2) {
    const std::string& key = row[i];
    const std::string& value = row[i + 1];
    if (key == "Format Version") trial.software = "OptiTrack Motive (format " + name_of_bytes(value) + ")";
    if (key == "Export Frame Rate" || key == "Capture Frame Rate") {
      const auto rate = parse_number(value);
      if (!rate) return bad(line, fmt::format("{} is '{}'; expected a number", key, excerpt(value)));
      if (auto s = check_rate(*rate, fmt::format("line {}: {}", line, key)); !s) return s;
      // What was exported is what the rows are.
      columns.rates_hz.insert(key[0] == 'E' ? columns.rates_hz.begin() : columns.rates_hz.end(), *rate);
    }
    if (key == "Total Exported Frames")
      if (const auto frames = parse_number(value); frames && std::abs(*frames) < 9e15)
        columns.stated_frames = static_cast<std::int64_t>(*frames);
    if (key == "Length Units") {
      const auto per_metre = units_per_metre(value, line);
      if (!per_metre) return std::unexpected(per_metre.error());
      columns.units_per_metre = *per_metre;
      trial.units_in_file = lower(value);
      has_unit = true;
    }
  }
  if (!has_unit) {
    columns.units_per_metre = 1.0;
    trial.warnings.emplace_back("line 1 names no Length Units; metres are assumed");
  }
  return {};
}

/// What each column is; a marker's three columns share type and name.
void lay_out(const MotiveRows& rows, MarkerColumns& columns, data::Trial& trial) {
  std::map<std::string, int> unread;
  std::map<std::string, std::int32_t> open;  // markers of which an axis is still to come
  std::vector<int> seen;
  columns.columns.push_back({.kind = Kind::frame});
  if (lower(cell(rows.axis, 1)).starts_with("time")) columns.columns.push_back({.kind = Kind::time});
  for (std::size_t c = columns.columns.size(); c < rows.axis.size(); ++c) {
    const std::string axis = rows.axis[c];
    const std::string type = rows.type.empty() ? "Marker" : cell(rows.type, c);
    const std::string part = rows.component.empty() ? "Position" : cell(rows.component, c);
    const bool coordinate = axis == "X" || axis == "Y" || axis == "Z";
    if (type != "Marker" || part != "Position" || !coordinate) {
      if (type != "Marker" && !type.empty()) ++unread[type];
      columns.columns.push_back({.kind = Kind::unread});
      continue;
    }
    const std::string name = name_of_bytes(cell(rows.name, c));
    const auto which = static_cast<std::int8_t>(axis[0] - 'X');
    auto at = open.find(name);
    // The same name again with an axis that it has: another marker of that name.
    if (at == open.end() || (seen[static_cast<std::size_t>(at->second)] & (1 << which)) != 0) {
      at = open.insert_or_assign(name, static_cast<std::int32_t>(columns.names.size())).first;
      columns.names.push_back(name);
      seen.push_back(0);
    }
    seen[static_cast<std::size_t>(at->second)] |= 1 << which;
    columns.columns.push_back({.kind = Kind::coordinate, .marker = at->second, .axis = which});
  }
  std::vector<std::string> parts;
  for (const auto& [type, count] : unread) parts.push_back(fmt::format("{} of {}", count, excerpt(type)));
  if (!parts.empty())
    trial.warnings.push_back(fmt::format("columns that are solved, not measured, are not read: {}",
                                         join_some(parts, parts.size())));
}

}  // namespace

Result<MotiveRows> parse_motive_rows(Lines& lines, MarkerColumns& columns, data::Trial& trial) {
  std::string_view line;
  if (!lines.next(line)) return fail(Code::bad_input, "the file is empty; expected a CSV file of Motive");
  const auto keys = split(line, lines.number());
  if (!keys) return std::unexpected(keys.error());
  if (auto s = read_keys(*keys, lines.number(), columns, trial); !s) return std::unexpected(s.error());
  return read_rows(lines);
}

Result<VendorHeader> parse_motive_header(Lines& lines, data::Trial& trial) {
  VendorHeader out;
  const auto rows = parse_motive_rows(lines, out.columns, trial);
  if (!rows) return std::unexpected(rows.error());
  if (rows->name.empty())
    return fail(Code::bad_input, fmt::format("line {}: the rows above it hold no names", lines.number()));
  out.columns.separator = ',';
  lay_out(*rows, out.columns, trial);
  if (out.columns.names.empty())
    return fail(Code::bad_input,
                fmt::format("line {}: no column is the position of a marker; export markers, not "
                            "only rigid bodies or skeletons",
                            rows->name_line));
  settle_marker_names(out.columns.names, rows->name_line, trial);
  return out;
}

}  // namespace kinemark::io::internal
