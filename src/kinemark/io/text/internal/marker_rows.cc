// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/marker_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/io/clock_time.h"

namespace kinemark::io::internal {
namespace {

using Kind = MarkerColumns::Kind;

constexpr double kNearOrigin_m = 0.005;
constexpr double kLargestFrame = 9e15;
constexpr double kSlowest_hz = 1.0;  // slower than this, times without a unit are asked about
constexpr std::size_t kNamesInWarning = 8;
// A row may stop early and still stands for all markers; this keeps a short text from asking for much memory.
constexpr std::size_t kSamplesPerByte = 2;  // bytes per sample, at least
constexpr std::size_t kSamplesAlways = 1'000'000;

/// The rows as they are read.
struct Rows {
  std::vector<double> time_s;                                     ///< where the file has times
  std::vector<std::int64_t> number;                               ///< frame numbers, where the file has them
  double resolution_s = std::numeric_limits<double>::infinity();  ///< of the times
  std::string first_instant;   ///< where times are those of a clock: the first, as it is written
  ClockTime first_clock;       ///< the same
  std::int64_t midnights = 0;  ///< passed by a clock without a date
  std::int64_t part_blank = 0, infinite = 0, marked = 0, short_rows = 0, extra_rows = 0;
};

/// A row with tabs between its cells.
std::string_view with_tabs(std::string_view line, char separator, std::string& buffer) {
  if (separator == '\t') return line;
  buffer.assign(line);
  std::ranges::replace(buffer, separator, '\t');
  return buffer;
}

/// A time of a clock, as seconds from the first; false where it is none, or where other rows have numbers.
bool take_instant(std::string_view text, Rows& rows) {
  constexpr double kDay_s = 86400.0;
  const auto clock = parse_clock_time(text);
  if (!clock || (rows.first_instant.empty() && !rows.time_s.empty())) return false;
  if (rows.first_instant.empty()) {
    rows.first_instant = text;
    rows.first_clock = *clock;
  }
  double time_s = clock->second - rows.first_clock.second +
                  kDay_s * static_cast<double>(clock->day - rows.first_clock.day + rows.midnights);
  const bool has_date = clock->day != 0;
  if (!has_date && !rows.time_s.empty() && time_s < rows.time_s.back() - 0.5 * kDay_s) {
    ++rows.midnights;
    time_s += kDay_s;
  }
  rows.time_s.push_back(time_s);
  rows.resolution_s = std::min(rows.resolution_s, clock->resolution_s);
  return true;
}

Status read_row(std::string_view text, std::int64_t line, const MarkerColumns& columns, double* x,
                Rows& rows) {
  Cells cells(text, Separator::tab);
  bool ended = false;
  std::int64_t place = 0;
  std::int32_t unseen = -1;  // the marker that its condition says was not seen
  for (const auto& column : columns.columns) {
    ++place;
    double number = kNaN;
    const Cell kind = cells.next(number);
    ended |= kind == Cell::none;
    switch (column.kind) {
      case Kind::unread:
        break;
      case Kind::frame:
        if (kind != Cell::number || !(std::abs(number) < kLargestFrame) || number != std::floor(number))
          return bad_cell(line, place, "the frame number", cells.text());
        rows.number.push_back(static_cast<std::int64_t>(number));
        break;
      case Kind::time:
        if (kind == Cell::text && take_instant(cells.text(), rows)) break;
        if (kind != Cell::number || !std::isfinite(number) || !rows.first_instant.empty())
          return bad_cell(line, place, "the time", cells.text());
        rows.time_s.push_back(number / columns.time_units_per_second);
        if (number != 0.0)
          rows.resolution_s =
              std::min(rows.resolution_s, resolution_of(cells.text()) / columns.time_units_per_second);
        break;
      case Kind::condition:
        if (kind == Cell::text)
          return bad_cell(line, place,
                          fmt::format("the condition of marker '{}'",
                                      excerpt(columns.names[static_cast<std::size_t>(column.marker)])),
                          cells.text());
        if (!(number > 0.0)) unseen = column.marker;
        break;
      case Kind::coordinate:
        if (kind == Cell::text)
          return bad_cell(line, place,
                          fmt::format("{} of marker '{}'", "xyz"[column.axis],
                                      excerpt(columns.names[static_cast<std::size_t>(column.marker)])),
                          cells.text());
        if (kind == Cell::number && column.marker != unseen)
          x[3 * column.marker + column.axis] = number / columns.units_per_metre;
        break;
    }
  }
  rows.short_rows += ended;
  if (ended) return {};
  double ignored = 0.0;
  for (Cell kind = cells.next(ignored); kind != Cell::none; kind = cells.next(ignored))
    if (kind != Cell::blank) {
      ++rows.extra_rows;
      break;
    }
  return {};
}

/// States of samples from their coordinates.
void settle_samples(data::Trajectories& markers, const MarkerColumns& columns, Rows& rows) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const Eigen::Vector3d x = markers.x(f, m), stored = x * columns.units_per_metre;
      if (m < markers.markers() - columns.others && marks_missing(stored.x(), stored.y(), stored.z())) {
        ++rows.marked;
        markers.set_missing(f, m);
        continue;
      }
      if (x.allFinite()) {
        markers.state[markers.index(f, m)] = data::SampleState::measured;
        continue;
      }
      const auto blank = x.array().isNaN().count();
      rows.part_blank += blank > 0 && blank < 3;
      rows.infinite += blank == 0;
      markers.set_missing(f, m);
    }
}

/// Where each row stands, for messages.
std::string place_of(const Rows& rows, std::int64_t first_line, std::size_t row) {
  const auto i = static_cast<std::int64_t>(row);
  return fmt::format("line {} (frame {})", first_line + i, rows.number.empty() ? i + 1 : rows.number[row]);
}

/// Frames by their numbers, at the stated rate; numbers without a row are missing frames.
Result<EvenClock> numbered_clock(const MarkerColumns& columns, const Rows& rows, std::int64_t first_line,
                                 std::int64_t count, std::int64_t most_frames, data::Trial& trial) {
  if (columns.rates_hz.empty())
    return fail(Code::bad_input, "the header states no frame rate and the rows hold no times");
  const double rate = columns.rates_hz.front();
  // Where frames count from 0 the first is at 0, as where they count from 1.
  const auto before = static_cast<double>(trial.first_frame == 0 ? 0 : trial.first_frame - 1);
  EvenClock out{.time = {.rate_hz = rate, .t0_s = before / rate, .frames = count}};
  if (rows.number.empty()) return out;
  for (std::size_t i = 1; i < rows.number.size(); ++i)
    if (rows.number[i] <= rows.number[i - 1])
      return fail(Code::bad_input,
                  fmt::format("{}: the frame number does not increase; expected more than {}",
                              place_of(rows, first_line, i), rows.number[i - 1]));
  const std::int64_t frames = rows.number.back() - rows.number.front() + 1;
  if (frames == count) return out;
  if (frames > most_frames)
    return fail(Code::bad_input,
                fmt::format("{}: {} frames for {} rows are more than are believed of this file",
                            place_of(rows, first_line, rows.number.size() - 1), frames, count));
  trial.warnings.push_back(
      fmt::format("{} frames between the rows have no row and are missing", frames - count));
  out.time.frames = frames;
  out.frame.reserve(rows.number.size());
  for (const std::int64_t number : rows.number) out.frame.push_back(number - rows.number.front());
  return out;
}

/// Times and frames from the time column, or else from frame numbers.
Status settle_time(const MarkerColumns& columns, const Rows& rows, std::int64_t first_line,
                   std::int64_t most_frames, data::Trial& trial) {
  data::Trajectories& markers = trial.markers;
  if (!rows.number.empty()) trial.first_frame = rows.number.front();
  const auto place = [&](std::size_t row) { return place_of(rows, first_line, row); };
  const auto clock =
      rows.time_s.empty()
          ? numbered_clock(columns, rows, first_line, markers.time.frames, most_frames, trial)
          : even_clock({.time_s = rows.time_s,
                        .resolution_s = std::isfinite(rows.resolution_s) ? rows.resolution_s : 0.0,
                        .stated = columns.rates_hz,
                        .most_frames = most_frames,
                        .place = place},
                       trial.warnings);
  if (!clock) return std::unexpected(clock.error());
  if (!rows.first_instant.empty())
    trial.warnings.push_back(
        fmt::format("times are those of a clock; they are taken as seconds from the first, '{}'",
                    excerpt(rows.first_instant)));
  if (columns.is_time_unit_open && rows.first_instant.empty() && clock->time.rate_hz <= kSlowest_hz)
    return fail(
        Code::bad_input,
        fmt::format("rows are {:.6g} s apart, if the times are in seconds; if they are in milliseconds, call "
                    "their column 'time_ms', else 'time_s'",
                    1.0 / clock->time.rate_hz));
  spread_rows(markers, *clock);
  return {};
}

void warn(const MarkerColumns& columns, const Rows& rows, std::int64_t count, data::Trial& trial) {
  const auto say = [&](std::string sentence) { trial.warnings.push_back(std::move(sentence)); };
  if (columns.stated_frames >= 0 && columns.stated_frames != count)
    say(fmt::format("header says {} frames, {} rows are there; the rows are used", columns.stated_frames,
                    count));
  if (rows.short_rows > 0)
    say(fmt::format("{} of {} rows end before the last marker; the rest of them is taken as not seen",
                    rows.short_rows, count));
  if (rows.extra_rows > 0)
    say(fmt::format("{} of {} rows hold cells beyond the last column; these are not read", rows.extra_rows,
                    count));
  if (rows.part_blank > 0)
    say(fmt::format("{} samples have one or two blank coordinates, taken as not seen", rows.part_blank));
  if (rows.marked > 0)
    say(fmt::format("{} samples are 999, 9999, ... in all coordinates, taken as not seen", rows.marked));
  if (rows.infinite > 0) say(fmt::format("{} samples are infinite, taken as not seen", rows.infinite));
}

}  // namespace

Status bad_cell(std::int64_t line, std::int64_t column, std::string_view what, std::string_view cell) {
  return fail(Code::bad_input, fmt::format("line {}, column {}: {} is {}; expected a number", line, column,
                                           what, cell.empty() ? "blank" : "'" + excerpt(cell) + "'"));
}

bool marks_missing(double x, double y, double z) {
  const double size = std::abs(x);
  if (!(size > 998.0) || std::abs(y - x) > 1e-9 * size || std::abs(z - x) > 1e-9 * size) return false;
  for (double nines = 999.0; nines < 1e10; nines = 10.0 * nines + 9.0)
    if (std::abs(size - nines) < 1e-9 * size) return true;
  return false;
}

double largest_extent(const data::Trajectories& markers) {
  double extent = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = kNaN, most = kNaN;
    for (std::size_t i = axis; i < markers.x_in_world.size(); i += 3)
      if (const double x = markers.x_in_world[i]; std::isfinite(x))
        least = std::fmin(least, x), most = std::fmax(most, x);
    extent = std::fmax(extent, most - least);
  }
  return extent;
}

void spread_rows(data::Trajectories& markers, const EvenClock& clock) {
  markers.time = clock.time;
  if (clock.frame.empty()) return;
  const data::Trajectories rows =
      std::exchange(markers, data::Trajectories::all_missing(markers.names, clock.time));
  const auto M = std::ssize(rows.names);
  for (std::int64_t row = 0; row < std::ssize(clock.frame); ++row) {
    const auto frame = clock.frame[static_cast<std::size_t>(row)];
    std::copy_n(rows.x_in_world.begin() + 3 * row * M, 3 * M, markers.x_in_world.begin() + 3 * frame * M);
    std::copy_n(rows.state.begin() + row * M, M, markers.state.begin() + frame * M);
  }
}

std::int64_t remove_zeros(data::Trajectories& markers, std::int64_t m) {
  const std::int64_t frames = markers.frames();
  const auto is_zero = [&](std::int64_t f) { return markers.present(f, m) && markers.x(f, m).isZero(0.0); };
  const auto beside_origin = [&](std::int64_t f) {
    return markers.present(f, m) && markers.x(f, m).norm() <= kNearOrigin_m;
  };
  std::int64_t removed = 0;
  for (std::int64_t begin = 0; begin < frames;) {
    std::int64_t end = begin;
    while (end < frames && is_zero(end)) ++end;
    if (end == begin) {
      ++begin;
      continue;
    }
    const bool passes_origin = (begin > 0 || end < frames) && (begin == 0 || beside_origin(begin - 1)) &&
                               (end == frames || beside_origin(end));
    for (std::int64_t f = begin; f < end && !passes_origin; ++f) markers.set_missing(f, m);
    removed += passes_origin ? 0 : end - begin;
    begin = end;
  }
  return removed;
}

Status read_marker_rows(Lines& lines, const MarkerColumns& columns, std::size_t text_bytes,
                        data::Trial& trial) {
  const auto count = static_cast<std::size_t>(lines.count_until_blank());
  const std::size_t markers = columns.names.size();
  if (markers == 0) return fail(Code::bad_input, fmt::format("line {}: names no marker", lines.number()));
  if (count == 0)
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends before the first row of data", lines.number() + 1));
  const std::size_t most_frames = (text_bytes / kSamplesPerByte + kSamplesAlways) / markers;
  if (count > most_frames)
    return fail(Code::bad_input,
                fmt::format("line {}: {} rows for {} markers do not fit into the {} bytes of this file",
                            lines.number() + 1, count, markers, text_bytes));
  const std::int64_t first_line = lines.number() + 1;
  trial.markers.names = columns.names;
  trial.markers.time.frames = static_cast<std::int64_t>(count);
  trial.markers.x_in_world.assign(3 * count * markers, kNaN);
  trial.markers.state.assign(count * markers, data::SampleState::missing);
  Rows rows;
  std::string buffer;
  std::string_view line;
  for (std::size_t row = 0; row < count; ++row) {
    lines.next(line);
    if (auto s = read_row(with_tabs(line, columns.separator, buffer), lines.number(), columns,
                          trial.markers.x_in_world.data() + 3 * row * markers, rows);
        !s)
      return s;
  }
  settle_samples(trial.markers, columns, rows);
  warn(columns, rows, static_cast<std::int64_t>(count), trial);
  if (auto s = settle_time(columns, rows, first_line, static_cast<std::int64_t>(most_frames), trial); !s)
    return s;
  if (columns.zeros_are_missing) take_zeros_as_missing(trial, columns.others);
  return {};
}

void take_zeros_as_missing(data::Trial& trial, std::int64_t others) {
  std::vector<std::string> names;
  std::int64_t zeros = 0;
  for (std::int64_t m = 0; m < trial.markers.markers() - others; ++m) {
    const std::int64_t removed = remove_zeros(trial.markers, m);
    if (removed == 0) continue;
    names.push_back("'" + excerpt(trial.markers.names[static_cast<std::size_t>(m)]) + "'");
    zeros += removed;
  }
  if (zeros > 0)
    trial.warnings.push_back(
        fmt::format("{} samples of {} markers are exactly (0, 0, 0), taken as not seen: {}", zeros,
                    names.size(), join_some(names, kNamesInWarning)));
}

}  // namespace kinemark::io::internal
