// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/coordinate_labels.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/io/position_name.h"
#include "kinemark/io/text/internal/csv_line.h"

namespace kinemark::io::internal {
namespace {

using Label = CoordinateLabel;

constexpr std::string_view kAxes = "xyzw";
constexpr std::string_view kDFlow = ".Pos";  // before the axis
constexpr int kMostTitles = 20;              // lines before the labels
constexpr std::size_t kLinesOfLabels = 3;

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_between(char c) { return kBetweenNameAndAxis.find(c) != std::string_view::npos; }

int axis_of(char c) {
  const auto at = kAxes.find(static_cast<char>(c | 0x20));
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// "frameno" of "Frame No.".
std::string letters_of(std::string_view text) {
  std::string out;
  for (const char c : lower(text))
    if (c >= 'a' && c <= 'z') out += c;
  return out;
}

/// "Time [s]" as "Time" and "s".
std::pair<std::string_view, std::string_view> split_unit(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}}) {
    const auto at = text.find_last_of(open);
    if (at != std::string_view::npos && at > 0 && text.ends_with(close))
      return {trim(text.substr(0, at)), trim(text.substr(at + 1, text.size() - at - 2))};
  }
  return {text, {}};
}

/// Words that say of x, y and z what they are, and not whose.
bool says_position(std::string_view word) {
  constexpr std::array<std::string_view, 6> kWords{"pos",         "position",    "positions",
                                                   "translation", "coordinates", "coord"};
  return is_one_of(kWords, lower(word));
}

/// "LASI" of "LASI_", "LASI position", "LASI.pos"; nothing of "pos".
std::string_view marker_of(std::string_view stem) {
  const auto cut = [&] {
    while (!stem.empty() && is_between(stem.back())) stem.remove_suffix(1);
  };
  cut();
  if (says_position(stem)) return {};
  const auto word = stem.find_last_of(kBetweenNameAndAxis);
  if (word != std::string_view::npos && word > 0 && says_position(stem.substr(word + 1))) {
    stem = stem.substr(0, word);
    cut();
  }
  return stem;
}

/// Gives a label the marker and the axis that its text names.
bool take_axis(std::string_view text, Label& out) {
  const auto set = [&](std::string_view stem, char axis) {
    out.name = marker_of(stem);
    out.axis = axis_of(axis);
    return true;
  };
  const std::size_t n = text.size();
  if (n == 0) return false;
  const int last = axis_of(text.back());
  if (last >= 0 && last < Label::kW && n > kDFlow.size() + 1 &&
      text.substr(n - kDFlow.size() - 1, kDFlow.size()) == kDFlow) {
    out.of_d_flow = true;
    out.name = text.substr(0, n - kDFlow.size() - 1);
    out.axis = last;
    return true;
  }
  if (last >= 0 && (n == 1 || is_between(text[n - 2]))) return set(text.substr(0, n - 1), text.back());
  const bool after_word = n > 5 && is_between(text[n - 5]) && lower(text.substr(n - 4, 3)) == "pos";
  if (last >= 0 && after_word) return set(text.substr(0, n - 4), text.back());
  if (n > 2 && axis_of(text.front()) >= 0 && is_between(text[1]) && !metres_per_unit(text.substr(2)))
    return set(trim(text.substr(2)), text.front());
  return false;
}

/// "LASIX": an axis without anything between. Short stems are of forces and the like: "FP1_Fx", "pelvis_tx".
bool take_axis_at_end(Label& label) {
  constexpr std::size_t kShortest = 3;
  const std::string_view text = label.name;
  if (label.axis >= 0 || text.size() <= kShortest || axis_of(text.back()) < 0) return false;
  const auto stem = text.substr(0, text.size() - 1);
  const auto word = stem.find_last_of(kBetweenNameAndAxis);
  if (stem.size() - (word == std::string_view::npos ? 0 : word + 1) < kShortest) return false;
  label.axis = axis_of(text.back());
  label.name = std::string(stem);
  return true;
}

/// "X1": of a point that has a number alone.
bool take_number(Label& label) {
  const std::string_view text = label.name;
  if (label.axis >= 0 || text.size() < 2 || text.size() > 5 || axis_of(text.front()) < 0) return false;
  if (!std::ranges::all_of(text.substr(1), [](char c) { return c >= '0' && c <= '9'; })) return false;
  label.axis = axis_of(text.front());
  label.name = "point " + std::string(text.substr(1));
  return true;
}

bool take_clock(Label& label) {
  constexpr std::array<std::string_view, 10> kFrames{"frame",   "frames",   "framenumber", "frameno",
                                                     "frameid", "frameidx", "fnum",        "field",
                                                     "framenr", "framenum"};
  constexpr std::array<std::string_view, 22> kTimes{
      "time",    "t",     "times",    "timestamp", "timestamps", "temps",    "second", "elapsedtime",
      "sec",     "zeit",  "tiempo",   "tempo",     "tijd",       "tid",      "secs",   "frametime",
      "utctime", "clock", "datetime", "seconds",   "timeofday",  "localtime"};
  std::string word = letters_of(label.name), unit = lower(label.unit);
  label.is_frame = is_one_of(kFrames, word);
  if (label.is_frame) return true;
  for (const std::string_view end : {"_s", "_ms", "_us", "_ns", "_sec", "_seconds"})
    if (unit.empty() && lower(label.name).ends_with(end) && word.size() + 1 > end.size()) {
      unit = end.substr(1);
      word.resize(word.size() - unit.size());
    }
  if (unit.empty() && word == "s") unit = word = "sec";
  if (!is_one_of(kTimes, word)) return false;
  constexpr std::array<std::string_view, 5> kSeconds{"s", "sec", "secs", "second", "seconds"};
  constexpr std::array<std::string_view, 5> kMilli{"ms", "msec", "msecs", "millisecond", "milliseconds"};
  constexpr std::array<std::string_view, 5> kMicro{"us", "\xC2\xB5s", "usec", "microsecond", "microseconds"};
  constexpr std::array<std::string_view, 4> kNano{"ns", "nsec", "nanosecond", "nanoseconds"};
  const bool says = is_one_of(kSeconds, unit) || is_one_of(kSeconds, word);
  label.units_per_second = is_one_of(kMilli, unit)   ? 1e3
                           : is_one_of(kMicro, unit) ? 1e6
                           : is_one_of(kNano, unit)  ? 1e9
                                                     : 1.0;
  label.is_time_unit_open = label.units_per_second == 1.0 && !says;
  return true;
}

/// True of "X", "Y1", "z": an axis alone, perhaps numbered.
int axis_alone(std::string_view cell) {
  const int axis = cell.empty() ? -1 : axis_of(cell.front());
  const bool numbered =
      cell.size() < 2 || std::ranges::all_of(cell.substr(1), [](char c) { return c >= '0' && c <= '9'; });
  return numbered && axis < Label::kW ? axis : -1;
}

/// Rows that a program has numbered stand first, under no label or one of its own.
void take_row_numbers(std::vector<Label>& labels) {
  constexpr std::array<std::string_view, 5> kWords{"", "index", "unnamed: 0", "coords", "bodyparts"};
  if (!labels.empty() && labels[0].axis < 0 && is_one_of(kWords, lower(labels[0].name)))
    labels[0].is_frame = true;
}

/// Puts the columns of each marker together; how many columns are coordinates.
std::size_t group(CoordinateLabels& table) {
  struct Marker {
    std::string name;
    std::array<std::size_t, 3> column{};
    std::array<bool, 3> has{};
  };
  std::vector<Marker> found;
  std::map<std::string, std::vector<std::size_t>, std::less<>> named;  // members in `found`
  std::set<std::string, std::less<>> turns;                            // names that have a fourth component
  auto& columns = table.columns;
  std::size_t others = 0;
  for (const auto& label : columns) {
    others += label.axis < 0 && !label.is_clock();
    if (label.axis == Label::kW) turns.insert(label.name);
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Label& label = columns[c];
    if (label.axis < 0 || label.axis >= Label::kW || label.is_clock() || names_no_position(label.name))
      continue;
    if (turns.contains(label.name)) continue;
    const auto axis = static_cast<std::size_t>(label.axis);
    auto& members = named[label.name];
    // A name that stands again with the same axis is another marker.
    if (members.empty() || found[members.back()].has[axis]) {
      members.push_back(found.size());
      found.push_back({.name = label.name});
    }
    Marker& marker = found[members.back()];
    marker.column[axis] = c;
    marker.has[axis] = true;
  }
  table.names.clear();
  std::size_t coordinates = 0;
  for (const auto& marker : found) {
    if (!marker.has[0] || !marker.has[1] || !marker.has[2]) continue;
    // x, y and z of nothing are a position only beside a clock, where nothing else stands.
    if (marker.name.empty() &&
        (others > 0 || found.size() > 1 || std::ranges::none_of(columns, &Label::is_clock)))
      continue;
    for (const std::size_t c : marker.column)
      columns[c].marker = static_cast<std::int32_t>(table.names.size());
    table.names.push_back(marker.name);
    coordinates += 3;
  }
  return coordinates;
}

/// Markers stand first, times and frames apart, or are half of all columns and more.
bool holds_markers(CoordinateLabels& table) {
  const std::size_t coordinates = group(table);
  if (coordinates == 0) return false;
  const auto clocks = static_cast<std::size_t>(std::ranges::count_if(table.columns, &Label::is_clock));
  const auto first = std::ranges::find_if_not(table.columns, &Label::is_clock);
  return first->marker >= 0 || 2 * coordinates >= table.columns.size() - clocks;
}

/// The labels of one line.
CoordinateLabels in_one_line(const std::vector<std::string>& cells,
                             const std::vector<std::string>& first_row) {
  CoordinateLabels out;
  for (const auto& cell : cells) out.columns.push_back(coordinate_label(cell));
  take_row_numbers(out.columns);
  if (holds_markers(out)) return out;
  if (auto numbered = out; take_numbered_axes(numbered.columns, first_row) && holds_markers(numbered)) {
    numbered.are_numbered = true;
    return numbered;
  }
  bool changed = false;
  for (auto& label : out.columns)
    changed = (!label.is_clock() && (take_axis_at_end(label) || take_number(label))) || changed;
  return changed && holds_markers(out) ? out : CoordinateLabels();
}

/// Names above a line of axes: each axis belongs to the name at or before it.
CoordinateLabels below_names(const std::vector<std::string>& names, const std::vector<std::string>& axes) {
  CoordinateLabels out;
  std::string name;
  for (std::size_t c = 0; c < std::max(names.size(), axes.size()); ++c) {
    const std::string above = c < names.size() ? names[c] : std::string();
    const std::string cell = c < axes.size() ? axes[c] : std::string();
    const auto [below, unit] = split_unit(cell);
    if (!above.empty()) name = above;
    const int axis = axis_alone(below);
    if (axis >= 0 && !coordinate_label(name).is_clock()) {
      Label label;
      label.name = name;
      label.axis = axis;
      label.unit = std::string(unit);
      out.columns.push_back(std::move(label));
    } else {
      out.columns.push_back(
          coordinate_label(below.empty() ? std::string_view(above) : std::string_view(cell)));
    }
  }
  take_row_numbers(out.columns);
  return holds_markers(out) ? out : CoordinateLabels();
}

/// Whether all cells but the first that are filled are units of length.
bool is_line_of_units(const std::vector<std::string>& cells) {
  std::size_t units = 0;
  for (std::size_t c = 1; c < cells.size(); ++c) {
    if (cells[c].empty()) continue;
    if (!metres_per_unit(cells[c])) return false;
    ++units;
  }
  return units >= 3;
}

bool is_line_of_axes(const std::vector<std::string>& cells) {
  std::size_t axes = 0;
  for (const auto& cell : cells) axes += axis_alone(split_unit(cell).first) >= 0;
  return axes >= 3 && 2 * axes >= cells.size();
}

/// The cells of the next line, without going there; none where it is no row of cells.
std::vector<std::string> next_cells(Lines ahead) {
  std::string_view line;
  std::vector<std::string> cells;
  if (!ahead.next(line) || !check_header_line(line, ahead.number()) || !split_labels(line, cells))
    cells.clear();
  return cells;
}

/// A line below the axes with the names of the columns that have none, and nothing else, as pandas writes it
/// ("time,,,"): these columns get them, and `lines` goes there.
void take_index_names(Lines& lines, std::vector<Label>& columns) {
  const auto cells = next_cells(lines);
  bool any = false;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (cells[c].empty()) continue;
    if (c >= columns.size() || columns[c].marker >= 0 || parse_number(cells[c])) return;
    any = true;
  }
  if (!any || cells.size() != columns.size()) return;
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!cells[c].empty()) columns[c] = coordinate_label(cells[c]);
  std::string_view line;
  lines.next(line);
}

/// The labels whose first line is the next one.
CoordinateLabels labels_here(Lines& lines) {
  std::vector<std::vector<std::string>> above;
  Lines ahead = lines;
  std::string_view line;
  for (std::size_t k = 0; k < kLinesOfLabels && ahead.next(line); ++k) {
    if (!check_header_line(line, ahead.number())) return {};
    std::vector<std::string> cells;
    const auto text = trim(line);
    const bool noted =
        text.starts_with('#') || text.starts_with('%');  // as numpy.savetxt() writes its header
    if (!split_labels(noted ? trim(text.substr(1)) : line, cells)) return {};
    if (k == 0) {
      auto found = in_one_line(cells, next_cells(ahead));
      if (!found.columns.empty()) return lines = ahead, found;
    } else if (is_line_of_axes(cells)) {
      // The names are the last line above that is none of units.
      auto names = std::find_if_not(above.rbegin(), above.rend(), is_line_of_units);
      if (names == above.rend()) return {};
      auto found = below_names(*names, cells);
      if (found.columns.empty()) return {};
      const auto units = std::ranges::find_if(above, is_line_of_units);
      if (units != above.end()) found.units = *units;
      take_index_names(ahead, found.columns);
      return lines = ahead, found;
    }
    above.push_back(std::move(cells));
  }
  return {};
}

std::size_t filled(std::string_view line) {
  std::vector<std::string> cells;
  if (!split_labels(line, cells)) return 0;
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [](const std::string& cell) { return !cell.empty(); }));
}

/// Whether lines before the labels may be passed over: not in files that have a head of their own.
bool may_have_titles(Lines lines) {
  std::string_view line;
  for (int k = 0; k < kMostTitles && lines.next(line); ++k) {
    const std::string word = lower(trim(line.substr(0, 12)));
    for (const std::string_view own : {"endheader", "item", "hierarchy", "pathfiletype", "<", "{", "["})
      if (word.starts_with(own)) return false;
  }
  return true;
}

}  // namespace

bool split_labels(std::string_view line, std::vector<std::string>& cells) {
  if (line.find('\t') == std::string_view::npos) return split_csv(line, cells);
  cells.clear();
  Cells walk(line, Separator::tab);
  for (std::string_view cell; walk.next_text(cell);) {
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.emplace_back(trim(cell));
  }
  return true;
}

CoordinateLabel coordinate_label(std::string_view cell) {
  auto [text, unit] = split_unit(trim(cell));
  Label out;
  out.name = std::string(text);
  out.unit = std::string(unit);
  if (take_clock(out)) return out;
  if (unit.size() == 1 && axis_of(unit.front()) >= 0) {  // "LASI(X)"
    out.axis = axis_of(unit.front());
    out.name = marker_of(text);
    out.unit.clear();
    return out;
  }
  if (take_axis(text, out)) return out;
  const auto end = text.find_last_of(kBetweenNameAndAxis);  // "LASI_X_mm"
  if (!unit.empty() || end == std::string_view::npos || !metres_per_unit(text.substr(end + 1))) return out;
  if (take_axis(text.substr(0, end), out)) out.unit = std::string(text.substr(end + 1));
  return out;
}

CoordinateLabels read_coordinate_labels(Lines& lines) {
  Lines start = lines;
  const int most = may_have_titles(lines) ? kMostTitles : 1;
  std::size_t widest = 0;
  std::string_view line;
  for (int k = 0; k < most; ++k) {
    Lines at = start;
    auto found = labels_here(at);
    // A title has few cells.
    if (!found.columns.empty() && 2 * widest <= found.columns.size()) return lines = at, found;
    if (!start.next(line) || !check_header_line(line, start.number())) return {};
    if (!trim(line).starts_with('#')) widest = std::max(widest, filled(line));
  }
  return {};
}

}  // namespace kinemark::io::internal
