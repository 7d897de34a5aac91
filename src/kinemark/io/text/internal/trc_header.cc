// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/trc_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

std::vector<std::string_view> split_by(Separator separator, std::string_view line) {
  Cells cells(line, separator);
  std::vector<std::string_view> out;
  for (std::string_view cell; cells.next_text(cell);) out.push_back(cell);
  return out;
}

/// Header lines are tab-separated like the rows, unless they hold no tab at all.
std::vector<std::string_view> split(std::string_view line) {
  return split_by(line.find('\t') == std::string_view::npos ? Separator::blanks : Separator::tab, line);
}

bool holds_blank(std::string_view cell) { return cell.find(' ') != std::string_view::npos; }

/// Keys hold no blanks: where one does, blanks stand between them too.
std::vector<std::string_view> split_keys(std::string_view line) {
  auto keys = split(line);
  return std::ranges::any_of(keys, holds_blank) ? split_by(Separator::blanks, line) : keys;
}

/// As many values as keys, by tabs where these give so many.
std::vector<std::string_view> split_values(std::string_view line, std::size_t keys) {
  auto values = split(line);
  if (values.size() >= keys) return values;
  auto by_blanks = split_by(Separator::blanks, line);
  return by_blanks.size() == keys ? by_blanks : values;
}

/// The line of names; marker names may hold blanks, "Frame#" and "Time" before them do not.
std::vector<std::string_view> split_names(std::string_view line) {
  auto cells = split(line);
  for (std::size_t c = 0; c < 2 && c < cells.size(); ++c) {
    const auto blank = cells[c].find(' ');
    if (blank == std::string_view::npos) continue;
    const auto rest = trim(cells[c].substr(blank));
    cells[c] = cells[c].substr(0, blank);
    cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(c) + 1, rest);
  }
  return cells;
}

/// Lines 2 and 3: keys above their values.
Status read_values(Lines& lines, TrcHeader& header) {
  std::string_view line;
  if (!lines.next(line))
    return fail(Code::bad_input, fmt::format("line {}: the file ends where the header's keys (DataRate, "
                                             "CameraRate, NumFrames, ...) were expected",
                                             lines.number() + 1));
  const auto keys = split_keys(line);
  if (std::ranges::none_of(keys, [](auto key) { return lower(key) == "datarate"; }))
    return fail(Code::bad_input, fmt::format("line {}: found '{}'; expected the header's keys (DataRate, "
                                             "CameraRate, NumFrames, ...)",
                                             lines.number(), excerpt(trim(line))));
  if (!lines.next(line) || is_blank(line))
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends where the values of the header were expected",
                            std::max<std::int64_t>(lines.number(), 3)));
  const auto values = split_values(line, keys.size());
  std::array<std::optional<double>, 3> rates;
  for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    const std::string key = lower(keys[i]);
    if (key == "units") header.units = values[i];
    const std::array<std::pair<std::string_view, std::optional<double>*>, 5> numbers{
        {{"datarate", rates.data()},
         {"camerarate", &rates[1]},
         {"origdatarate", &rates[2]},
         {"numframes", &header.frames},
         {"nummarkers", &header.markers}}};
    for (const auto& [word, target] : numbers) {
      if (key != word || values[i].empty()) continue;
      std::string value(values[i]);
      std::ranges::replace(value, ',', '.');  // "119,88" above rows with points
      *target = parse_number(value);
      if (!*target)
        return fail(Code::bad_input, fmt::format("line {}, column {} ({}): '{}' is not a number",
                                                 lines.number(), i + 1, keys[i], excerpt(values[i])));
    }
  }
  // The others only stand in for the first, so nothing is said where they are not known.
  std::vector<std::string> unsaid;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (!rates[k]) continue;
    constexpr std::array<std::string_view, 3> kKeys{"DataRate", "CameraRate", "OrigDataRate"};
    const auto stated = states_rate(*rates[k], fmt::format("line {}: {}", lines.number(), kKeys[k]),
                                    k == 0 ? header.warnings : unsaid);
    if (!stated) return std::unexpected(stated.error());
    if (*stated) header.rates_hz.push_back(*rates[k]);
  }
  if (header.units.empty()) {
    header.warnings.push_back("header names no unit; millimetres are assumed");
    return {};
  }
  header.units_line = lines.number();
  if (const auto metres = metres_per_unit(header.units)) {
    header.units_per_metre = 1.0 / *metres;
    return {};
  }
  header.units_like = units_like(header.units);
  header.units_per_metre = 1.0;
  if (!header.units_like.empty()) return {};
  return fail(Code::bad_input, fmt::format("line {}: unit '{}' is unknown; expected mm, cm or m",
                                           header.units_line, excerpt(header.units)));
}

/// Line 4: Frame#, Time and the names, each above its three columns or packed without gaps.
Status read_names(Lines& lines, TrcHeader& header) {
  std::string_view line;
  if (!lines.next(line))
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends where the line with Frame#, Time and the "
                            "marker names was expected",
                            lines.number() + 1));
  const auto cells = split_names(line);
  if (cells.size() < 2 || !lower(cells[0]).starts_with("frame") || !lower(cells[1]).starts_with("time"))
    return fail(Code::bad_input,
                fmt::format("line {}: found '{}'; expected the line with Frame#, Time and the marker names",
                            lines.number(), excerpt(trim(line))));
  if (line.find('\t') == std::string_view::npos) header.separator = Separator::blanks;

  // Cell numbers of the names. Each third cell: a name stands above its x column, and a gap is an unnamed
  // marker. Anything else (packed, or shifted by a tab) gives the order only.
  std::vector<std::size_t> name_cells;
  std::vector<std::string> names;
  for (std::size_t c = 2; c < cells.size(); ++c) {
    auto name = name_of_bytes(cells[c]);
    if (name.empty()) continue;
    name_cells.push_back(c);
    names.push_back(std::move(name));
  }
  if (name_cells.empty())
    return fail(Code::bad_input, fmt::format("line {}: names no marker", lines.number()));
  const bool above = std::ranges::all_of(name_cells, [](std::size_t c) { return c % 3 == 2; });
  for (std::size_t i = 0; i < name_cells.size(); ++i) {
    const std::size_t slot = above ? (name_cells[i] - 2) / 3 : i;
    header.marker.resize(slot + 1, -1);
    header.marker[slot] = static_cast<std::int32_t>(i);
  }
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    header.warnings.push_back(
        fmt::format("line {} repeats {} marker names ('{}' is the first); a number is added to each",
                    lines.number(), repeated.changed, excerpt(repeated.example)));
  header.names = std::move(names);
  if (header.marker.size() > header.names.size())
    header.warnings.push_back(fmt::format("{} markers between the named ones have no name and are not read",
                                          header.marker.size() - header.names.size()));
  if (header.markers && *header.markers != static_cast<double>(header.names.size()))
    header.warnings.push_back(fmt::format("header says {} markers, {} are named; the names are used",
                                          *header.markers, header.names.size()));
  return {};
}

/// True for the line of X1 Y1 Z1 labels (any line whose first filled cell is no number).
bool is_axis_labels(std::string_view line, Separator separator) {
  Cells cells(line, separator);
  double ignored = 0.0;
  Cell kind = cells.next(ignored);
  while (kind == Cell::blank) kind = cells.next(ignored);
  return kind == Cell::text;
}

/// The line of X1 Y1 Z1 labels where it names another order than x, y, z. Code::bad_input where it names one
/// twice or not for each marker, as coordinates would be exchanged then.
Status read_axes(std::string_view line, std::int64_t number, TrcHeader& header) {
  std::vector<std::uint8_t> found;
  Cells cells(line, header.separator);
  for (std::string_view cell; cells.next_text(cell);) {
    if (cell.empty()) continue;
    const auto axis = std::string_view("xyz").find(static_cast<char>(cell.front() | 0x20));
    const bool is_label = std::ranges::all_of(cell.substr(1), [](char c) { return c >= '0' && c <= '9'; });
    if (axis == std::string_view::npos || !is_label) return {};  // words of another kind
    found.push_back(static_cast<std::uint8_t>(axis));
  }
  bool usual = true;
  for (std::size_t i = 0; i < found.size(); ++i) usual = usual && found[i] == i % 3;
  if (usual) return {};
  const std::size_t slots = header.marker.size();
  for (std::size_t k = 0; k < slots && 3 * k + 2 < found.size(); ++k) {
    std::array<std::uint8_t, 3> order{found[3 * k], found[3 * k + 1], found[3 * k + 2]};
    header.axes.push_back(order);
    std::ranges::sort(order);
    if (order != std::array<std::uint8_t, 3>{0, 1, 2}) header.axes.clear(), found.clear();
  }
  if (header.axes.size() == slots) return {};
  return fail(
      Code::bad_input,
      fmt::format("line {}: does not name x, y and z of each of the {} markers; expected X1, Y1, Z1, X2, "
                  "...",
                  number, slots));
}

}  // namespace

Result<TrcHeader> parse_trc_header(Lines& lines) {
  TrcHeader header;
  std::string_view line;
  for (Lines ahead = lines; ahead.number() < 4 && ahead.next(line);)
    if (auto status = check_header_line(line, ahead.number()); !status)
      return std::unexpected(status.error());
  if (!lines.next(line)) return fail(Code::bad_input, "the file is empty; expected a TRC file");
  const auto first = split_by(Separator::blanks, line);
  if (first.empty() || lower(first[0]) != "pathfiletype")
    return fail(Code::bad_input, "line 1: is no head of a TRC file; a TRC file begins with PathFileType");
  if (auto status = read_values(lines, header); !status) return std::unexpected(status.error());
  if (auto status = read_names(lines, header); !status) return std::unexpected(status.error());

  // The axis labels and blank lines in any number; the first row stays for the caller.
  bool labels_seen = false;
  for (Lines ahead = lines; ahead.next(line); lines = ahead) {
    if (is_blank(line)) continue;
    if (labels_seen || !is_axis_labels(line, header.separator)) break;
    labels_seen = true;
    if (auto status = read_axes(line, ahead.number(), header); !status)
      return std::unexpected(status.error());
  }
  return header;
}

}  // namespace kinemark::io::internal
