// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text/d_flow_forces.h"
#include "kinemark/io/text/internal/coordinate_labels.h"
#include "kinemark/io/text/internal/vendor_headers.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;

constexpr std::size_t kNamed = 8;

/// Where a line of units stands below the labels, whose cells above coordinates all are units of length: its
/// cells.
std::vector<std::string> units_below(Lines& lines, const std::vector<MarkerColumns::Column>& columns) {
  Lines ahead = lines;
  std::string_view line;
  std::vector<std::string> cells;
  if (!ahead.next(line) || !check_header_line(line, ahead.number()) || !split_labels(line, cells)) return {};
  cells.resize(columns.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::string& cell = cells[c];
    if (cell.size() > 2 && (cell.front() == '(' || cell.front() == '['))
      cell = cell.substr(1, cell.size() - 2);
    if (columns[c].kind == Kind::coordinate && !metres_per_unit(cell)) return {};
  }
  lines = ahead;
  return cells;
}

}  // namespace

bool begins_coordinates(std::string_view begin) {
  Lines lines(begin);
  return !read_coordinate_labels(lines).columns.empty();
}

bool begins_coordinates_without_times(std::string_view begin) {
  Lines lines(begin);
  const auto labels = read_coordinate_labels(lines).columns;
  return !labels.empty() && std::ranges::none_of(labels, [](const CoordinateLabel& label) {
    return label.units_per_second > 0.0;
  });
}

bool begins_d_flow(std::string_view begin) {
  Lines lines(begin);
  return std::ranges::any_of(read_coordinate_labels(lines).columns, &CoordinateLabel::of_d_flow);
}

Result<VendorHeader> parse_coordinates_header(Lines& lines, data::Trial& trial, std::string_view unit,
                                              double rate_hz) {
  auto table = read_coordinate_labels(lines);
  const auto& labels = table.columns;
  if (labels.empty()) return fail(Code::bad_input, "line 1: labels no columns of x, y and z of a marker");
  const auto line = lines.number();
  VendorHeader out;
  std::vector<std::string> stated;  // of coordinates, where a label has one
  std::vector<std::string> unread, whole;
  for (const auto& label : labels) whole.push_back(label.name);
  const auto forces = d_flow_force_labels(whole);  // read_d_flow_forces() reads them
  auto& columns = out.columns.columns;
  bool has_time = false, has_frame = false;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const auto& label = labels[c];
    if (label.marker >= 0) {
      columns.push_back(
          {.kind = Kind::coordinate, .marker = label.marker, .axis = static_cast<std::int8_t>(label.axis)});
      if (!label.unit.empty()) stated.push_back(label.unit);
      if (c < table.units.size() && !table.units[c].empty()) stated.push_back(table.units[c]);
      continue;
    }
    const bool is_time = label.units_per_second > 0.0 && !has_time;
    const bool is_frame = label.is_frame && !has_frame;
    if (is_time) {
      out.columns.time_units_per_second = label.units_per_second;
      out.columns.is_time_unit_open = label.is_time_unit_open;
    }
    has_time = has_time || is_time;
    has_frame = has_frame || is_frame;
    columns.push_back({.kind = is_time ? Kind::time : is_frame ? Kind::frame : Kind::unread});
    if (!is_time && !is_frame && !label.name.empty() && std::ranges::find(forces, label.name) == forces.end())
      unread.push_back(fmt::format("'{}'", excerpt(label.name)));
  }
  for (const auto& name : table.names) out.columns.names.push_back(name_of_bytes(name));
  if (!has_time && !is_rate(rate_hz))
    return fail(
        rate_hz == 0.0 ? Code::bad_input : Code::usage,
        fmt::format("line {}: is a table of coordinates without a column of times; give its frame rate "
                    "with --rate HZ, or a column called 'time', in seconds",
                    line));
  if (!has_time) out.columns.rates_hz.push_back(rate_hz);
  if (!unread.empty())
    trial.warnings.push_back(
        fmt::format("{} of {} columns are no coordinates of markers and are not read: {}", unread.size(),
                    labels.size(), join_some(unread, kNamed)));
  settle_marker_names(out.columns.names, line, trial);
  const auto below = units_below(lines, columns);
  for (std::size_t c = 0; c < below.size(); ++c)
    if (columns[c].kind == Kind::coordinate) stated.push_back(below[c]);
  if (stated.empty() && !unit.empty()) stated.emplace_back(unit);
  if (stated.empty() && table.names.front().empty())
    return fail(
        Code::bad_input,
        fmt::format("line {}: x, y and z name no marker, and nothing tells that they are a position; if "
                    "they are, give their unit of length with --unit mm, cm or m",
                    line));
  if (table.are_numbered && stated.empty())
    return fail(
        Code::bad_input,
        fmt::format(
            "line {}: has three numbered columns of each name ('{}'), and nothing tells that they are "
            "x, y and z of a marker; if they are, give their unit of length with --unit mm, cm or m",
            line, excerpt(table.names.front())));
  if (table.are_numbered)
    trial.warnings.push_back(
        fmt::format("its three numbered columns of each name ('{}') are taken for x, y and z",
                    excerpt(table.names.front())));
  if (std::ranges::any_of(labels, &CoordinateLabel::of_d_flow)) {
    // D-Flow streams metres.
    trial.format = "D-Flow";
    if (!forces.empty()) trial.unread.emplace_back(kForcesOfDFlow);
    if (stated.empty()) stated.emplace_back("m");
  }
  out.is_unit_open = stated.empty();
  out.columns.zeros_are_missing = !out.is_unit_open;  // else once the unit is known
  out.columns.units_per_metre = 1.0;
  for (const auto& word : stated) {
    const auto per_metre = units_per_metre(word, line);
    if (!per_metre) return std::unexpected(per_metre.error());
    if (&word != stated.data() && *per_metre != out.columns.units_per_metre)
      return fail(Code::bad_input,
                  fmt::format("line {}: some coordinates are in '{}', others in '{}'; expected one unit",
                              line, excerpt(stated.front()), excerpt(word)));
    out.columns.units_per_metre = *per_metre;
  }
  if (!stated.empty()) trial.units_in_file = stated.front();
  // Separators are commas or tabs by now (text_dialect.h).
  Lines ahead = lines;
  std::string_view row;
  out.columns.separator = ahead.next(row) && row.find('\t') != std::string_view::npos ? '\t' : ',';
  return out;
}

}  // namespace kinemark::io::internal
