// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/internal/vendor_headers.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;

constexpr std::size_t kNamed = 8;

/// A label in its parts: "LASI_X (mm)" is of marker LASI, axis 0, in mm; "Time [s]" is "Time" in s.
struct Label {
  std::string name;        ///< of the marker, or the whole label
  int axis = -1;           ///< 0, 1, 2 of x, y, z; negative: no coordinate
  std::string unit;        ///< empty: none stated
  bool of_d_flow = false;  ///< "LASI.PosX"
};

constexpr std::string_view kDFlow = ".Pos";  // before the axis

/// "Time [s]" as "Time" and "s".
std::pair<std::string_view, std::string_view> split_unit(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}}) {
    const auto at = text.find_last_of(open);
    if (at != std::string_view::npos && at > 0 && text.ends_with(close))
      return {trim(text.substr(0, at)), trim(text.substr(at + 1, text.size() - at - 2))};
  }
  return {text, {}};
}

Label label_of(std::string_view cell) {
  const auto [text, unit] = split_unit(trim(cell));
  Label out{.name = std::string(text), .unit = std::string(unit)};
  constexpr std::string_view kAxes = "xyz", kBetween = "_.: -";
  if (text.empty()) return out;
  const auto axis = kAxes.find(static_cast<char>(text.back() | 0x20));
  const auto d_flow = text.size() > kDFlow.size() + 1 ? text.size() - kDFlow.size() - 1 : 0;
  if (axis != std::string_view::npos && d_flow > 0 && text.substr(d_flow, kDFlow.size()) == kDFlow) {
    out.axis = static_cast<int>(axis);
    out.name = text.substr(0, d_flow);
    out.of_d_flow = true;
    return out;
  }
  const bool parted = text.size() == 1 || kBetween.find(text[text.size() - 2]) != std::string_view::npos;
  if (axis == std::string_view::npos || !parted) return out;
  out.axis = static_cast<int>(axis);
  out.name = trim(text.substr(0, text.size() - std::min<std::size_t>(text.size(), 2)));
  return out;
}

enum class Clock : std::uint8_t { none, frame, seconds, milliseconds };

/// "frameno" of "Frame No.".
std::string letters_of(std::string_view text) {
  std::string out;
  for (const char c : lower(text))
    if (c >= 'a' && c <= 'z') out += c;
  return out;
}

Clock clock_of(const Label& label) {
  const std::string word = lower(label.name);
  constexpr std::array<std::string_view, 7> kFrames{"frame",   "frames",   "framenumber", "frameno",
                                                    "frameid", "frameidx", "fnum"};
  if (std::ranges::find(kFrames, letters_of(word)) != kFrames.end()) return Clock::frame;
  constexpr std::array<std::string_view, 6> kTimes{"time", "t", "time_s", "times", "timestamp", "seconds"};
  if (std::ranges::find(kTimes, word) == kTimes.end() && word != "time_ms") return Clock::none;
  const std::string unit = lower(label.unit);
  return word == "time_ms" || unit == "ms" || unit == "msec" ? Clock::milliseconds : Clock::seconds;
}

bool split(std::string_view line, std::vector<std::string>& cells) {
  if (line.find('\t') == std::string_view::npos) return split_csv(line, cells);
  cells.clear();
  Cells walk(line, Separator::tab);
  for (std::string_view cell; walk.next_text(cell);) {
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.emplace_back(trim(cell));
  }
  return true;
}

/// True of "X", "Y1", "z": an axis alone, perhaps numbered.
int axis_alone(std::string_view cell) {
  const auto axis =
      std::string_view("xyz").find(cell.empty() ? '\0' : static_cast<char>(cell.front() | 0x20));
  const bool numbered =
      cell.size() < 2 || std::ranges::all_of(cell.substr(1), [](char c) { return c >= '0' && c <= '9'; });
  return axis == std::string_view::npos || !numbered ? -1 : static_cast<int>(axis);
}

/// Whether a name says that its x, y and z are no position: "acc", "wrist_force", "Angular velocity".
bool is_no_position(std::string_view name) {
  constexpr std::array<std::string_view, 14> kOthers{"acc",   "accel",  "gyr",    "gyro",  "mag",
                                                     "vel",   "speed",  "angle",  "euler", "quat",
                                                     "force", "moment", "torque", "grf"};
  constexpr std::array<std::string_view, 6> kBegun{"accelerat", "gyroscop", "magnet",
                                                   "velocit",   "angular",  "rotat"};
  std::string word;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    if (const char c = i < name.size() ? static_cast<char>(name[i] | 0x20) : ' '; c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    if (std::ranges::find(kOthers, word) != kOthers.end() ||
        std::ranges::any_of(kBegun, [&](std::string_view begun) { return word.starts_with(begun); }))
      return true;
    word.clear();
  }
  return false;
}

bool is_triple(const std::vector<Label>& labels, std::size_t c) {
  if (c + 2 >= labels.size() || labels[c].name.empty() || is_no_position(labels[c].name)) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (labels[c + k].axis != static_cast<int>(k) || labels[c + k].name != labels[c].name) return false;
  return true;
}

std::vector<Label> labels_of(const std::vector<std::string>& cells) {
  std::vector<Label> out;
  for (const auto& cell : cells) out.push_back(label_of(cell));
  return out;
}

/// Labels of names above a line of axes: each axis belongs to the name at or before it.
std::vector<Label> labels_of(const std::vector<std::string>& names, const std::vector<std::string>& axes) {
  std::vector<Label> out(std::max(names.size(), axes.size()));
  std::string name;
  for (std::size_t c = 0; c < out.size(); ++c) {
    const std::string above = c < names.size() ? names[c] : std::string();
    const auto [below, unit] = split_unit(c < axes.size() ? std::string_view(axes[c]) : std::string_view());
    if (!above.empty()) name = above;
    const int axis = axis_alone(below);
    if (axis >= 0 && clock_of(label_of(name)) == Clock::none)
      out[c] = {.name = name, .axis = axis, .unit = std::string(unit)};
    else
      out[c] = label_of(below.empty() ? std::string_view(above) : std::string_view(axes[c]));
  }
  return out;
}

/// Of a column; rows that a program has numbered stand first, under no label or "Unnamed: 0".
Clock clock_of(const std::vector<Label>& labels, std::size_t c) {
  const std::string word = lower(labels[c].name);
  const bool counts = labels[c].axis < 0 && (word.empty() || word == "index" || word == "unnamed: 0");
  return c == 0 && counts ? Clock::frame : clock_of(labels[c]);
}

/// Times and frames first, then a marker.
bool holds_markers(const std::vector<Label>& labels) {
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (is_triple(labels, c)) return true;
    if (clock_of(labels, c) == Clock::none) return false;
  }
  return false;
}

/// Reads the lines of labels; `lines` is then at the last of them.
std::vector<Label> read_labels(Lines& lines) {
  std::string_view line;
  if (!lines.next(line) || !check_header_line(line, 1)) return {};
  std::vector<std::string> first, second;
  if (!split(line, first)) return {};
  auto labels = labels_of(first);
  if (holds_markers(labels)) return labels;
  Lines ahead = lines;
  if (!ahead.next(line) || !check_header_line(line, 2) || !split(line, second)) return {};
  labels = labels_of(first, second);
  if (!holds_markers(labels)) return {};
  lines = ahead;
  return labels;
}

/// Where a line of units stands below the labels, whose cells above coordinates all are units of length: its
/// cells.
std::vector<std::string> units_below(Lines& lines, const std::vector<MarkerColumns::Column>& columns) {
  Lines ahead = lines;
  std::string_view line;
  std::vector<std::string> cells;
  if (!ahead.next(line) || !check_header_line(line, ahead.number()) || !split(line, cells)) return {};
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
  return !read_labels(lines).empty();
}

bool begins_coordinates_without_times(std::string_view begin) {
  Lines lines(begin);
  const auto labels = read_labels(lines);
  return !labels.empty() && std::ranges::none_of(labels, [](const Label& label) {
    const Clock clock = clock_of(label);
    return clock == Clock::seconds || clock == Clock::milliseconds;
  });
}

bool begins_d_flow(std::string_view begin) {
  Lines lines(begin);
  return std::ranges::any_of(read_labels(lines), &Label::of_d_flow);
}

Result<VendorHeader> parse_coordinates_header(Lines& lines, data::Trial& trial, std::string_view unit,
                                              double rate_hz) {
  const auto labels = read_labels(lines);
  if (labels.empty()) return fail(Code::bad_input, "line 1: labels no columns of x, y and z of a marker");
  const auto line = lines.number();
  VendorHeader out;
  std::vector<std::string> stated;  // of coordinates, where a label has one
  std::vector<std::string> unread;
  auto& columns = out.columns.columns;
  bool has_time = false;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (is_triple(labels, c)) {
      for (int k = 0; k < 3; ++k)
        columns.push_back({.kind = Kind::coordinate,
                           .marker = static_cast<std::int32_t>(out.columns.names.size()),
                           .axis = static_cast<std::int8_t>(k)});
      out.columns.names.push_back(name_of_bytes(labels[c].name));
      for (const std::size_t k : {c, c + 1, c + 2})
        if (!labels[k].unit.empty()) stated.push_back(labels[k].unit);
      c += 2;
      continue;
    }
    const Clock clock = clock_of(labels, c);
    if (clock == Clock::milliseconds)
      return fail(
          Code::bad_input,
          fmt::format("line {}, column {}: times are in milliseconds; expected seconds", line, c + 1));
    const bool is_time = clock == Clock::seconds && !has_time;
    has_time = has_time || is_time;
    columns.push_back({.kind = is_time ? Kind::time : clock == Clock::frame ? Kind::frame : Kind::unread});
    if (!is_time && clock != Clock::frame && !labels[c].name.empty())
      unread.push_back(fmt::format("'{}'", excerpt(labels[c].name)));
  }
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
  if (std::ranges::any_of(labels, &Label::of_d_flow)) {
    // D-Flow streams metres, and zeros of what it does not see.
    trial.format = "D-Flow";
    out.columns.zeros_are_missing = true;
    if (stated.empty()) stated.emplace_back("m");
  }
  out.is_unit_open = stated.empty();
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
