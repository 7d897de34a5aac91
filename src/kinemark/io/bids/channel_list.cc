// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/bids/channel_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  for (;;) {
    const auto at = line.find('\t');
    out.push_back(trim(line.substr(0, at)));
    if (at == std::string_view::npos) return out;
    line.remove_prefix(at + 1);
  }
}

std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  const auto line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void add_point(std::vector<MotionColumn>& out, const MotionColumn& of) {
  for (const std::string_view axis : kAxes) {
    MotionColumn column = of;
    column.name = fmt::format("{}_{}", of.point, axis);
    column.component = axis;
    out.push_back(std::move(column));
  }
}

}  // namespace

std::vector<MotionColumn> columns_of(const data::Trial& trial) {
  std::vector<MotionColumn> out;
  for (const std::string& marker : trial.markers.names)
    add_point(
        out,
        {.name = {}, .component = {}, .type = "POS", .point = marker, .units = "m", .description = "marker"});
  const auto& c = trial.channels;
  for (std::size_t i = 0; i < c.names.size(); ++i)
    add_point(out, {.name = {},
                    .component = {},
                    .type = c.kinds[i] == data::ChannelKind::angle ? "JNTANG" : "MISC",
                    .point = c.names[i],
                    .units = c.units[i].empty() ? "n/a" : c.units[i],
                    .description = std::string(data::to_string(c.kinds[i]))});
  if (trial.markers.time.t0_s != 0.0)
    out.push_back({.name = "latency",
                   .component = "n/a",
                   .type = "LATENCY",
                   .point = "n/a",
                   .units = "s",
                   .description = "time of the frame"});
  std::vector<std::string> names;
  for (const MotionColumn& column : out) names.push_back(column.name);
  make_distinct(names);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].name = names[i];
  return out;
}

std::string format_columns(const std::vector<MotionColumn>& columns) {
  std::string out = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\tdescription\n";
  for (const MotionColumn& c : columns)
    fmt::format_to(std::back_inserter(out), "{}\t{}\t{}\t{}\t{}\tlaboratory\t{}\n", c.name, c.component,
                   c.type, c.point, c.units, c.description);
  return out;
}

Result<std::vector<MotionColumn>> parse_columns(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto head = cells_of(take_line(text));
  const auto place = [&](std::string_view name) { return std::ranges::find(head, name) - head.begin(); };
  std::array<std::ptrdiff_t, 6> at{};
  constexpr std::array<std::string_view, 6> kNames = {"name",          "component", "type",
                                                      "tracked_point", "units",     "description"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    at[i] = place(kNames[i]);
    if (i < 5 && at[i] == std::ssize(head))
      return fail(Code::bad_input,
                  fmt::format("line 1: no column {}; expected name, component, type, tracked_point and units",
                              kNames[i]));
  }
  std::vector<MotionColumn> out;
  for (std::int64_t line = 2; !text.empty(); ++line) {
    const auto row = take_line(text);
    if (trim(row).empty()) continue;
    const auto cells = cells_of(row);
    if (cells.size() != head.size())
      return fail(Code::bad_input,
                  fmt::format("line {}: {} cells under {} names", line, cells.size(), head.size()));
    const auto cell = [&](std::size_t i) {
      return at[i] == std::ssize(head) ? std::string()
                                       : name_of_bytes(cells[static_cast<std::size_t>(at[i])]);
    };
    out.push_back({.name = cell(0),
                   .component = cell(1),
                   .type = cell(2),
                   .point = cell(3),
                   .units = cell(4),
                   .description = cell(5)});
  }
  return out;
}

}  // namespace kinemark::io
