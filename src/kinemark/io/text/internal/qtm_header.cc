// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The header of a TSV file of Qualisys Track Manager: a keyword a line, in any order, then perhaps a row of
// column names.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text/internal/vendor_headers.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;

constexpr std::size_t kNamesInWarning = 8;

std::vector<std::string_view> split_tabs(std::string_view line) {
  Cells cells(line, Separator::tab);
  std::vector<std::string_view> out;
  for (std::string_view cell; cells.next_text(cell);) out.push_back(cell);
  while (!out.empty() && out.back().empty()) out.pop_back();
  return out;
}

/// Words of capital letters, digits and underscores.
bool is_keyword(std::string_view cell) {
  return cell.size() > 2 && cell[0] >= 'A' && cell[0] <= 'Z' && std::ranges::all_of(cell, [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
         });
}

/// What the lines of keywords say.
struct Keywords {
  double rate_hz = 0.0;
  std::int64_t frames = -1, markers = -1;
  std::int64_t names_line = 0;
  std::vector<std::string> names, types;
};

Status read_number(const std::vector<std::string_view>& cells, std::int64_t line, double& out) {
  const auto number = cells.size() > 1 ? parse_number(cells[1]) : std::nullopt;
  if (!number || !std::isfinite(*number))
    return fail(Code::bad_input, fmt::format("line {}: {} is '{}'; expected a number", line, cells[0],
                                             cells.size() > 1 ? excerpt(cells[1]) : ""));
  out = *number;
  return {};
}

Status read_count(const std::vector<std::string_view>& cells, std::int64_t line, std::int64_t& out) {
  double number = 0.0;
  if (auto s = read_number(cells, line, number); !s) return s;
  out = std::abs(number) < 9e15 ? static_cast<std::int64_t>(number) : -1;
  return {};
}

/// EVENT, label, frame, time.
void read_event(const std::vector<std::string_view>& cells, std::int64_t line, data::Trial& trial) {
  const auto time = cells.size() > 3 ? parse_number(cells[3]) : std::nullopt;
  if (time && std::isfinite(*time))
    trial.events.push_back({.label = name_of_bytes(cells[1]), .context = "", .time_s = *time});
  else
    trial.warnings.push_back(fmt::format("line {}: the event has no time and is not read", line));
}

Status read_keyword(const std::vector<std::string_view>& cells, std::int64_t line, Keywords& found,
                    data::Trial& trial) {
  const std::string_view key = cells[0];
  if (key == "NO_OF_FRAMES") return read_count(cells, line, found.frames);
  if (key == "NO_OF_MARKERS") return read_count(cells, line, found.markers);
  if (key == "FREQUENCY") {
    if (auto s = read_number(cells, line, found.rate_hz); !s) return s;
    return check_rate(found.rate_hz, fmt::format("line {}: FREQUENCY", line));
  }
  if (key == "DATA_INCLUDED" && cells.size() > 1 && cells[1] != "3D")
    return fail(Code::not_supported,
                fmt::format("line {}: the file holds {} data; 3D data are read", line, excerpt(cells[1])));
  if (key == "BODY_NAMES")
    return fail(Code::not_supported,
                fmt::format("line {}: the file holds rigid bodies (6DOF); 3D data are read", line));
  if (key == "EVENT") read_event(cells, line, trial);
  if (key == "MARKER_NAMES") {
    found.names_line = line;
    for (std::size_t i = 1; i < cells.size(); ++i) found.names.push_back(name_of_bytes(cells[i]));
  }
  if (key == "TRAJECTORY_TYPES")
    for (std::size_t i = 1; i < cells.size(); ++i) found.types.emplace_back(cells[i]);
  return {};
}

/// States by the types that QTM names, and the warning about what cannot be kept apart.
std::vector<data::SampleState> states_of(const Keywords& found, data::Trial& trial) {
  std::vector<data::SampleState> out(found.names.size(), data::SampleState::measured);
  std::vector<std::string> mixed;
  for (std::size_t i = 0; i < std::min(out.size(), found.types.size()); ++i) {
    const std::string type = lower(found.types[i]);
    if (type == "virtual" || type == "gap-filled") out[i] = data::SampleState::interpolated;
    if (type == "mixed" || type == "edited") mixed.push_back("'" + excerpt(found.names[i]) + "'");
  }
  if (!mixed.empty())
    trial.warnings.push_back(fmt::format(
        "filled samples cannot be kept apart from measured ones in trajectories that are mixed or "
        "edited: {}",
        join_some(mixed, kNamesInWarning)));
  return out;
}

/// How many columns stand before the coordinates: 0, 1 (frame) or 2 (frame and time).
Result<std::size_t> count_lead(Lines& lines, std::size_t names) {
  std::string_view line;
  Lines ahead = lines;
  if (!ahead.next(line))
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends before the first row of data", lines.number() + 1));
  const auto cells = split_tabs(line);
  if (!cells.empty() && !parse_number(cells[0]) && lower(cells[0]) != "null") {
    lines = ahead;  // column names
    if (lower(cells[0]) != "frame") return 0;
    return cells.size() > 1 && lower(cells[1]) == "time" ? 2 : 1;
  }
  // Without column names the width says it; trailing blank cells do not count.
  return std::min<std::size_t>(cells.size() > 3 * names ? cells.size() - 3 * names : 0, 2);
}

}  // namespace

Result<VendorHeader> parse_qtm_header(Lines& lines, data::Trial& trial) {
  Keywords found;
  std::string_view line;
  for (Lines ahead = lines; ahead.next(line); lines = ahead) {
    if (auto s = check_header_line(line, ahead.number()); !s) return std::unexpected(s.error());
    const auto cells = split_tabs(line);
    if (cells.empty()) continue;
    if (!is_keyword(cells[0])) break;
    if (auto s = read_keyword(cells, ahead.number(), found, trial); !s) return std::unexpected(s.error());
  }
  if (found.names.empty())
    return fail(Code::bad_input,
                fmt::format("line {}: the header ends without MARKER_NAMES; export 3D data with "
                            "a header",
                            lines.number() + 1));
  if (found.markers >= 0 && found.markers != std::ssize(found.names))
    trial.warnings.push_back(fmt::format("header says {} markers, {} are named; the names are used",
                                         found.markers, found.names.size()));
  VendorHeader out;
  out.state = states_of(found, trial);
  settle_marker_names(found.names, found.names_line, trial);
  const auto lead = count_lead(lines, found.names.size());
  if (!lead) return std::unexpected(lead.error());
  if (*lead > 0) out.columns.columns.push_back({.kind = Kind::frame});
  if (*lead > 1) out.columns.columns.push_back({.kind = Kind::time});
  for (std::int32_t m = 0; m < static_cast<std::int32_t>(found.names.size()); ++m)
    for (std::int8_t axis = 0; axis < 3; ++axis)
      out.columns.columns.push_back({.kind = Kind::coordinate, .marker = m, .axis = axis});
  out.columns.names = std::move(found.names);
  if (found.rate_hz > 0.0) out.columns.rates_hz.push_back(found.rate_hz);
  out.columns.stated_frames = found.frames;
  out.columns.zeros_are_missing = true;
  trial.software = "Qualisys Track Manager";
  trial.units_in_file = "mm";
  return out;
}

}  // namespace kinemark::io::internal
