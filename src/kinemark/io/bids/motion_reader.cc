// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/distinct_names.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/bids/channel_list.h"
#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/file.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using data::ChannelKind;
using data::SampleState;

constexpr std::size_t kMostSidecarBytes = 64UL << 20;
constexpr std::size_t kNamesInWarning = 5;
constexpr double kMostFrame = 1e15;
constexpr double kOffClock = 0.5;  // of a frame

/// What motion.json says.
struct Sidecar {
  double rate_hz = 0.0;
  std::string missing = "n/a";
  std::string software;
};

std::string text_of(const nlohmann::json& json, const char* key, std::string otherwise) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::move(otherwise);
}

Result<Sidecar> parse_sidecar(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return fail(Code::bad_input, "is no object of JSON");
  Sidecar out;
  const auto rate = json.find("SamplingFrequency");
  out.rate_hz = rate != json.end() && rate->is_number() ? rate->get<double>() : 0.0;
  if (auto s = check_rate(out.rate_hz, "SamplingFrequency"); !s) return std::unexpected(s.error());
  out.missing = text_of(json, "MissingValues", out.missing);
  out.software = name_of_bytes(text_of(json, "SoftwareVersions", ""));
  return out;
}

/// Three columns of a tracked point, by their places in the table.
struct Triple {
  std::string point, type, units, description;
  std::array<std::ptrdiff_t, 3> column = {-1, -1, -1};
  [[nodiscard]] bool whole() const { return std::ranges::min(column) >= 0; }
};

int axis_of(std::string_view component) {
  return component == "x" ? 0 : component == "y" ? 1 : component == "z" ? 2 : -1;
}

/// Columns that belong together, in the order of their first; those that do not are named.
std::vector<Triple> join_columns(const std::vector<MotionColumn>& columns,
                                 std::vector<std::string>& left_out) {
  std::vector<Triple> out;
  std::map<std::pair<std::string, std::string>, std::size_t> open;
  std::vector<std::string> alone;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const MotionColumn& c = columns[i];
    const int axis = axis_of(c.component);
    if (c.type == "LATENCY") continue;
    if (axis < 0 || c.point.empty() || c.point == "n/a") {
      alone.push_back(c.name);
      continue;
    }
    const auto key = std::pair(c.type, c.point);
    auto found = open.find(key);
    // A second x of the same point begins anew.
    if (found == open.end() || out[found->second].column[axis] >= 0) {
      found = open.insert_or_assign(key, out.size()).first;
      out.push_back({.point = c.point, .type = c.type, .units = c.units, .description = c.description});
    }
    out[found->second].column[axis] = static_cast<std::ptrdiff_t>(i);
  }
  for (const Triple& t : out)
    if (!t.whole()) alone.push_back(t.point);
  std::erase_if(out, [](const Triple& t) { return !t.whole(); });
  left_out = std::move(alone);
  return out;
}

ChannelKind kind_of(const Triple& t) {
  for (int k = 0; k <= std::to_underlying(ChannelKind::other); ++k)
    if (data::to_string(static_cast<ChannelKind>(k)) == t.description) return static_cast<ChannelKind>(k);
  return t.type == "JNTANG" ? ChannelKind::angle : ChannelKind::other;
}

/// The numbers of the table, row after row.
struct Numbers {
  Array<double> values;
  std::int64_t rows = 0;
};

/// Whether a cell stands for a missing number: the word itself, or the same number written otherwise.
bool is_missing(std::string_view cell, std::optional<double> number, std::string_view missing) {
  const auto word = parse_number(missing);
  return cell == missing || !number || !std::isfinite(*number) || (word && *word == *number);
}

Status parse_row(std::string_view row, std::size_t width, std::string_view missing, Array<double>& out) {
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    const auto at = row.find('\t');
    const auto cell = trim(row.substr(0, at));
    more = at != std::string_view::npos;
    if (more) row.remove_prefix(at + 1);
    if (count == width)
      return fail(Code::bad_input, fmt::format("more columns; channels.tsv names {}", width));
    const auto number = parse_number(cell);
    if (!number && cell != missing && cell != "n/a" && !cell.empty())
      return fail(Code::bad_input, fmt::format("column {}: '{}'; expected a number or {}", count + 1,
                                               printable(cell, 40), printable(missing, 40)));
    out.push_back(is_missing(cell, number, missing) ? kNaN : *number);
  }
  if (count != width)
    return fail(Code::bad_input, fmt::format("{}; channels.tsv names {}", counted(count, "column"), width));
  return {};
}

Result<Numbers> parse_numbers(std::string_view text, std::size_t width, std::string_view missing) {
  Numbers out;
  for (std::int64_t line = 1; !text.empty(); ++line) {
    const auto end = text.find('\n');
    const auto row = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (trim(row).empty()) {
      if (trim(text).empty()) break;
      return fail(Code::bad_input,
                  fmt::format("line {}: is blank; expected {}", line, counted(width, "column")));
    }
    if (auto s = parse_row(row, width, missing, out.values); !s)
      return fail_at(fmt::format("line {}", line), s.error());
    ++out.rows;
  }
  return out;
}

void take_marker(const Numbers& numbers, std::size_t width, const Triple& t, std::int64_t m, double metres,
                 data::Trajectories& out) {
  for (std::int64_t f = 0; f < numbers.rows; ++f) {
    Eigen::Vector3d x;
    for (int axis = 0; axis < 3; ++axis)
      x[axis] =
          metres *
          numbers.values[static_cast<std::size_t>(f) * width + static_cast<std::size_t>(t.column[axis])];
    if (!x.allFinite()) continue;
    out.x(f, m) = x;
    out.state[out.index(f, m)] = SampleState::measured;
  }
}

void take_channels(const Numbers& numbers, std::size_t width, const std::vector<Triple>& from, double rate_hz,
                   data::Channels& out) {
  if (from.empty()) return;
  for (const Triple& t : from) {
    out.names.push_back(t.point);
    out.kinds.push_back(kind_of(t));
    out.units.push_back(t.units == "n/a" ? "" : t.units);
  }
  make_distinct(out.names);
  out.rate_hz = rate_hz;
  out.frames = numbers.rows;
  out.values.resize(static_cast<std::size_t>(numbers.rows) * from.size() * 3);
  std::size_t at = 0;
  for (std::int64_t f = 0; f < numbers.rows; ++f)
    for (const Triple& t : from)
      for (const std::ptrdiff_t column : t.column)
        out.values[at++] =
            numbers.values[static_cast<std::size_t>(f) * width + static_cast<std::size_t>(column)];
}

/// The first time of the column of times, and whether the others are where the rate puts them.
void take_clock(const std::vector<MotionColumn>& columns, const Numbers& numbers, data::Trial& trial) {
  const auto found = std::ranges::find(columns, "LATENCY", &MotionColumn::type);
  if (found == columns.end()) return;
  auto& time = trial.markers.time;
  const auto at = [&](std::int64_t f) {
    return numbers.values[static_cast<std::size_t>(f) * columns.size() +
                          static_cast<std::size_t>(found - columns.begin())];
  };
  if (!std::isfinite(at(0)) || std::abs(at(0) * time.rate_hz) > kMostFrame) {
    trial.warnings.push_back(fmt::format("column {} has no first time and is left out", found->name));
    return;
  }
  time.t0_s = at(0);
  if (time.t0_s > 0.0) trial.first_frame = std::llround(time.t0_s * time.rate_hz) + 1;
  for (std::int64_t f = 1; f < numbers.rows; ++f)
    if (std::abs(at(f) - time.time_s(f)) * time.rate_hz > kOffClock) {
      trial.warnings.push_back(
          fmt::format("column {} puts frame {} at {} s and the rate at {} s; the rate is used", found->name,
                      f + 1, at(f), time.time_s(f)));
      return;
    }
}

Result<data::Trial> assemble(const std::vector<MotionColumn>& columns, const Numbers& numbers,
                             const Sidecar& sidecar) {
  data::Trial trial{.format = "Motion-BIDS", .software = sidecar.software};
  std::vector<std::string> left_out, names;
  std::vector<Triple> markers, others;
  for (Triple& t : join_columns(columns, left_out))
    (t.type == "POS" ? markers : others).push_back(std::move(t));
  if (markers.empty())
    return fail(Code::bad_input, "no tracked point has columns of type POS for x, y and z");
  if (!left_out.empty())
    trial.warnings.push_back(fmt::format("{} of no x, y and z left out: {}",
                                         left_out.size() == 1 ? "what is" : "those that are",
                                         join_some(left_out, kNamesInWarning)));
  for (const Triple& t : markers) names.push_back(t.point);
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    trial.warnings.push_back(
        fmt::format("'{}' is the name of several points; numbers are added", repeated.example));
  trial.units_in_file = markers.front().units;
  trial.markers =
      data::Trajectories::all_missing(std::move(names), {.rate_hz = sidecar.rate_hz, .frames = numbers.rows});
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto metres = metres_per_unit(markers[m].units);
    if (!metres)
      return fail(Code::bad_input,
                  fmt::format("{} is in '{}'; expected a unit of length", printable(markers[m].point, 80),
                              printable(markers[m].units, 40)));
    take_marker(numbers, columns.size(), markers[m], static_cast<std::int64_t>(m), *metres, trial.markers);
  }
  take_channels(numbers, columns.size(), others, sidecar.rate_hz, trial.channels);
  take_clock(columns, numbers, trial);
  return trial;
}

}  // namespace

Result<data::Trial> parse_motion_bids(const MotionTexts& texts) {
  const auto columns = parse_columns(texts.channels);
  if (!columns) return fail_at(texts.channels_name, columns.error());
  if (columns->empty()) return fail(Code::bad_input, fmt::format("{}: names no column", texts.channels_name));
  const auto sidecar = parse_sidecar(texts.json);
  if (!sidecar) return fail_at(texts.json_name, sidecar.error());
  const auto numbers = parse_numbers(texts.motion, columns->size(), sidecar->missing);
  if (!numbers) return fail_at(texts.motion_name, numbers.error());
  if (numbers->rows == 0) return fail(Code::bad_input, fmt::format("{}: holds no row", texts.motion_name));
  auto trial = assemble(*columns, *numbers, *sidecar);
  if (!trial) return fail_at(texts.channels_name, trial.error());
  trial->source = texts.motion_name;
  return trial;
}

Result<data::Trial> read_motion_bids(const std::filesystem::path& path) {
  if (!is_motion_tsv(path))
    return fail(Code::bad_input,
                fmt::format("{}: is no export of QTM, which begins with a header (export it with that), and "
                            "no recording of Motion-BIDS, which ends in _motion.tsv",
                            path.string()));
  std::array<std::string, 2> texts;
  MotionTexts out{.motion = {},
                  .channels = {},
                  .json = {},
                  .motion_name = path.string(),
                  .channels_name = {},
                  .json_name = {}};
  const struct {
    const char* ending;
    std::string* text;
    std::string* name;
  } sidecars[] = {{"channels.tsv", texts.data(), &out.channels_name},
                  {"motion.json", &texts[1], &out.json_name}};
  for (const auto& sidecar : sidecars) {
    const auto found = find_sidecar(path, sidecar.ending);
    if (!found)
      return fail(Code::bad_input,
                  fmt::format("{}: has no {} beside it or above it", path.string(), sidecar.ending));
    auto text = read_text(*found, kMostSidecarBytes);
    if (!text) return std::unexpected(text.error());
    *sidecar.text = std::move(*text);
    *sidecar.name = found->string();
  }
  const auto motion = read_lines_of_text(path);
  if (!motion) return std::unexpected(motion.error());
  out.motion = *motion;
  out.channels = texts[0];
  out.json = texts[1];
  return parse_motion_bids(out);
}

}  // namespace kinemark::io
