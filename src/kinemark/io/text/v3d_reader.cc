// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/v3d_header.h"
#include "kinemark/io/text/v3d.h"
#include "kinemark/io/text_input.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using internal::Cell;
using internal::Cells;
using internal::excerpt;
using internal::Lines;
using internal::V3dHeader;
using Kind = V3dHeader::Slot::Kind;

// A row may stop early and still stands for all signals; this keeps a short text from asking for much memory.
constexpr std::size_t kSamplesPerByte = 2;  // bytes per sample, at least
constexpr std::size_t kSamplesAlways = 1'000'000;

/// Properties of the rows besides their numbers.
struct Tally {
  std::int64_t part_blank = 0, short_rows = 0, extra_rows = 0, jumps = 0;
};

/// The number that a row begins with.
Status read_item(Cells& cells, std::int64_t line, std::int64_t& item) {
  double number = 0.0;
  const Cell kind = cells.next(number);
  if (kind != Cell::number || !(std::abs(number) < 9e15) || number != std::floor(number))
    return fail(Code::bad_input, fmt::format("line {}, column 1: ITEM is '{}'; expected a whole number", line,
                                             excerpt(cells.text())));
  item = static_cast<std::int64_t>(number);
  return {};
}

/// The cells of one row into the frame's points (3 per point) and angles (3 per signal).
Status read_cells(Cells& cells, std::int64_t line, const V3dHeader& header, double* points, double* angles,
                  Tally& tally) {
  bool ended = false;
  for (std::size_t c = 0; c < header.slots.size(); ++c) {
    const auto& slot = header.slots[c];
    double number = kNaN;
    const Cell kind = cells.next(number);
    ended |= kind == Cell::none;
    if (slot.kind == Kind::unread) continue;
    if (kind == Cell::text) {
      const auto& names = slot.kind == Kind::point ? header.points : header.angles;
      return fail(Code::bad_input,
                  fmt::format("line {}, column {}: {} of signal '{}' is '{}'; expected a number", line, c + 2,
                              "XYZ"[slot.axis], excerpt(names[static_cast<std::size_t>(slot.signal)]),
                              excerpt(cells.text())));
    }
    double* out = slot.kind == Kind::point ? points : angles;
    out[3 * slot.signal + slot.axis] = kind == Cell::number && std::isfinite(number) ? number : kNaN;
  }
  tally.short_rows += ended;
  if (ended) return {};
  double ignored = 0.0;
  for (Cell kind = cells.next(ignored); kind != Cell::none; kind = cells.next(ignored))
    if (kind != Cell::blank) {
      ++tally.extra_rows;
      break;
    }
  return {};
}

/// Samples with a missing coordinate are missing as a whole.
void settle_points(data::Trajectories& markers, Tally& tally) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const auto x = markers.x(f, m);
      const auto blank = x.array().isNaN().count();
      if (blank == 0) {
        markers.state[markers.index(f, m)] = data::SampleState::measured;
      } else {
        tally.part_blank += blank < 3;
        markers.set_missing(f, m);
      }
    }
}

void warn(data::Trial& trial, const Tally& tally, std::int64_t next_text_line) {
  const auto rows = trial.markers.frames();
  const auto say = [&](std::string sentence) { trial.warnings.push_back(std::move(sentence)); };
  if (next_text_line > 0)
    say(fmt::format("a blank line ends the data; line {} and what follows is not read", next_text_line));
  if (tally.jumps > 0)
    say(fmt::format("ITEM jumps {} times; frames are counted from {} on", tally.jumps, trial.first_frame));
  if (tally.short_rows > 0)
    say(fmt::format("{} of {} rows end before the last column; the rest of them is taken as not seen",
                    tally.short_rows, rows));
  if (tally.extra_rows > 0)
    say(fmt::format("{} of {} rows hold cells beyond the last column; these are not read", tally.extra_rows,
                    rows));
  if (tally.part_blank > 0)
    say(fmt::format("{} samples have one or two blank coordinates, taken as not seen", tally.part_blank));
}

Result<V3dFile> parse(std::string_view text, double rate_hz) {
  Lines lines(text);
  auto header = internal::parse_v3d_header(lines);
  if (!header) return std::unexpected(header.error());
  const auto rows = static_cast<std::size_t>(lines.count_until_blank());
  const std::size_t points = header->points.size();
  const std::size_t signals = header->angles.size();
  if (rows == 0) return fail(Code::bad_input, "line 6: the file ends before the first row of data");
  if (rows > (text.size() / kSamplesPerByte + kSamplesAlways) / (points + signals))
    return fail(Code::bad_input, fmt::format("line 6: {} rows of {} signals do not fit into the {} bytes of "
                                             "this file",
                                             rows, points + signals, text.size()));

  V3dFile out;
  data::Trial& trial = out.trial;
  trial.format = "Visual3D text";
  trial.units_in_file = "m";
  trial.warnings = header->warnings;
  trial.markers.x_in_world.assign(3 * rows * points, kNaN);
  trial.markers.state.assign(rows * points, data::SampleState::missing);
  out.orientations.angles_deg.assign(3 * rows * signals, kNaN);
  Tally tally;
  std::int64_t expected = 0;
  std::string_view line;
  for (std::size_t row = 0; row < rows; ++row) {
    lines.next(line);
    Cells cells(line, internal::Separator::tab);
    std::int64_t item = 0;
    if (auto status = read_item(cells, lines.number(), item); !status) return std::unexpected(status.error());
    if (row == 0) trial.first_frame = item;
    tally.jumps += row > 0 && item != expected;
    expected = item + 1;
    if (auto status =
            read_cells(cells, lines.number(), *header, trial.markers.x_in_world.data() + 3 * row * points,
                       out.orientations.angles_deg.data() + 3 * row * signals, tally);
        !status)
      return std::unexpected(status.error());
  }
  const std::int64_t next_text_line = lines.skip_blank();

  trial.markers.names = std::move(header->points);
  trial.markers.time = {.rate_hz = rate_hz, .t0_s = 0.0, .frames = static_cast<std::int64_t>(rows)};
  out.orientations.names = std::move(header->angles);
  out.orientations.frames = static_cast<std::int64_t>(rows);
  out.recorded_as = std::move(header->recorded_as);
  settle_points(trial.markers, tally);
  warn(trial, tally, next_text_line);
  return out;
}

}  // namespace

std::int64_t SegmentOrientations::find(std::string_view name) const {
  const auto at = std::ranges::find(names, name);
  return at == names.end() ? -1 : at - names.begin();
}

Eigen::Vector3d SegmentOrientations::angles(std::int64_t frame, std::int64_t signal) const {
  const auto signals = static_cast<std::int64_t>(names.size());
  return kRadPerDeg * Eigen::Map<const Eigen::Vector3d>(angles_deg.data() + 3 * (frame * signals + signal));
}

Eigen::Matrix3d SegmentOrientations::world_from_segment(std::int64_t frame, std::int64_t signal) const {
  return math::from_body_xyz(angles(frame, signal));
}

Result<V3dFile> parse_v3d(std::string_view text, std::string_view name, const V3dReadOptions& options) {
  if (!is_rate(options.rate_hz))
    return fail(Code::usage,
                fmt::format("{}: a Visual3D text export stores no rate; give the rate of its rows "
                            "in Hz (--rate)",
                            name));
  auto file = parse(text, options.rate_hz);
  if (!file) return fail_at(name, file.error());
  file->trial.source = name;
  return file;
}

Result<V3dFile> read_v3d(const std::filesystem::path& path, const V3dReadOptions& options) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_v3d(*text, path.string(), options);
}

}  // namespace kinemark::io
