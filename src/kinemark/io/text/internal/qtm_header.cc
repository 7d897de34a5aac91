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
  bool is_of_bodies = false;     ///< names are those of rigid bodies
  std::int64_t bodies_line = 0;  ///< that says that data of bodies are included, 0 without
};

// A rigid body's columns: X Y Z, three angles, residual, and the rotation matrix column by column.
constexpr std::size_t kColumnsOfBody = 16;
constexpr std::size_t kAngles = 3, kRotation = 7;  // where they begin

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
  if (key == "DATA_INCLUDED" && cells.size() > 1 && cells[1] != "3D" && cells[1] != "6D")
    return fail(Code::not_supported, fmt::format("line {}: the file holds {} data; 3D and 6D data are read",
                                                 line, excerpt(cells[1])));
  if (key == "DATA_INCLUDED" && cells.size() > 1 && cells[1] == "6D") found.bodies_line = line;
  if (key == "EVENT") read_event(cells, line, trial);
  if (key == "MARKER_NAMES" || key == "BODY_NAMES") {
    if (found.names_line > 0)
      return fail(Code::not_supported,
                  fmt::format("line {}: names bodies and markers; export them in files of their own", line));
    found.is_of_bodies = key == "BODY_NAMES";
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

/// How many columns stand before the `width` others: 0, 1 (frame) or 2 (frame and time).
Result<std::size_t> count_lead(Lines& lines, std::size_t width) {
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
  return std::min<std::size_t>(cells.size() > width ? cells.size() - width : 0, 2);
}

/// Code::not_supported unless the row of names or numbers ahead has as many cells as the bodies need.
Status check_body_columns(Lines ahead, std::size_t bodies) {
  std::string_view line;
  if (!ahead.next(line)) return {};
  const std::size_t cells = split_tabs(line).size(), need = bodies * kColumnsOfBody;
  if (cells >= need && cells <= need + 2) return {};
  return fail(Code::not_supported,
              fmt::format("line {}: {} columns for {} rigid bodies; need 16 for each: X, Y, Z, three angles, "
                          "residual and the nine numbers of the rotation",
                          ahead.number(), cells, bodies));
}

/// Origins of bodies, then what becomes channels: three angles and the three axes of each.
void set_body_columns(std::vector<std::string> bodies, VendorHeader& out) {
  const auto count = std::ssize(bodies);
  const auto place = [](std::size_t column, std::int64_t marker) {
    return MarkerColumns::Column{.kind = Kind::coordinate,
                                 .marker = static_cast<std::int32_t>(marker),
                                 .axis = static_cast<std::int8_t>(column % 3)};
  };
  auto& names = out.columns.names;
  names = std::move(bodies);
  for (std::int64_t b = 0; b < count; ++b) {
    const std::string body = names[static_cast<std::size_t>(b)];
    const std::int64_t first = count + 4 * b;
    for (std::size_t c = 0; c < kColumnsOfBody; ++c) {
      if (c < kAngles)
        out.columns.columns.push_back(place(c, b));
      else if (c < kAngles + 3)
        out.columns.columns.push_back(place(c - kAngles, first));
      else if (c < kRotation)
        out.columns.columns.push_back({.kind = Kind::unread});
      else
        out.columns.columns.push_back(
            place(c - kRotation, first + 1 + static_cast<std::int64_t>((c - kRotation) / 3)));
    }
    names.push_back(body + "_angles");
    out.outputs.push_back({.body = b, .kind = data::ChannelKind::angle, .unit = "deg"});
    for (const char axis : {'x', 'y', 'z'}) {
      names.push_back(fmt::format("{}_axis_{}", body, axis));
      out.outputs.push_back({.body = b, .kind = data::ChannelKind::other, .unit = ""});
    }
  }
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
                fmt::format("line {}: the header ends without MARKER_NAMES or BODY_NAMES; export "
                            "data with a header",
                            lines.number() + 1));
  if (found.markers >= 0 && found.markers != std::ssize(found.names))
    trial.warnings.push_back(fmt::format("header says {} markers, {} are named; the names are used",
                                         found.markers, found.names.size()));
  if (found.bodies_line > 0 && !found.is_of_bodies)
    return fail(Code::bad_input,
                fmt::format("line {}: the file holds 6D data, and no line BODY_NAMES names its bodies",
                            found.bodies_line));
  VendorHeader out;
  out.state = states_of(found, trial);
  settle_marker_names(found.names, found.names_line, trial);
  const std::size_t width = found.names.size() * (found.is_of_bodies ? kColumnsOfBody : 3);
  if (found.is_of_bodies)
    if (auto s = check_body_columns(lines, found.names.size()); !s) return std::unexpected(s.error());
  const auto lead = count_lead(lines, width);
  if (!lead) return std::unexpected(lead.error());
  if (*lead > 0) out.columns.columns.push_back({.kind = Kind::frame});
  if (*lead > 1) out.columns.columns.push_back({.kind = Kind::time});
  if (found.is_of_bodies) {
    set_body_columns(std::move(found.names), out);
    out.columns.others = std::ssize(out.outputs);
  } else {
    for (std::int32_t m = 0; m < static_cast<std::int32_t>(found.names.size()); ++m)
      for (std::int8_t axis = 0; axis < 3; ++axis)
        out.columns.columns.push_back({.kind = Kind::coordinate, .marker = m, .axis = axis});
    out.columns.names = std::move(found.names);
  }
  if (found.rate_hz > 0.0) out.columns.rates_hz.push_back(found.rate_hz);
  out.columns.stated_frames = found.frames;
  out.columns.zeros_are_missing = true;
  trial.software = "Qualisys Track Manager";
  trial.units_in_file = "mm";
  return out;
}

}  // namespace kinemark::io::internal
