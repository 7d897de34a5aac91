// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/marker_rows.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text/internal/trc_header.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::bad_cell;
using internal::Cell;
using internal::Cells;
using internal::excerpt;
using internal::Lines;
using internal::TrcHeader;

constexpr std::size_t kNamesInWarning = 8;
// A row may stop early and still stands for all markers; this keeps a short text from asking for much memory.
constexpr std::size_t kSamplesPerByte = 2;  // bytes per sample, at least
constexpr std::size_t kSamplesAlways = 1'000'000;

/// Properties of the rows besides their numbers.
struct Tally {
  std::vector<double> time_s;
  double resolution_s = std::numeric_limits<double>::infinity();  ///< of the time column
  std::int64_t part_blank = 0;  ///< samples with some cells blank or NaN, not all
  std::int64_t infinite = 0;
  std::int64_t marked = 0;  ///< 9999 and the like in all coordinates
  std::int64_t short_rows = 0;
  std::int64_t extra_rows = 0;        ///< rows with numbers beyond the last marker
  std::int64_t frame_jumps = 0;       ///< rows whose frame number does not follow the one before
  std::vector<std::int64_t> zeros;    ///< M, samples that are exactly (0, 0, 0)
  std::vector<std::int64_t> present;  ///< M, samples with coordinates, zeros included
};

/// Frame# and Time.
Status read_row_start(Cells& cells, std::int64_t line, data::Trial& trial, Tally& tally,
                      std::int64_t& frame_number) {
  double number = 0.0;
  const std::int64_t expected = frame_number + 1;
  const Cell kind = cells.next(number);
  if (kind == Cell::number && std::abs(number) < 9e15 && number == std::floor(number))
    frame_number = static_cast<std::int64_t>(number);
  else if (kind == Cell::blank)
    frame_number = expected;
  else
    return bad_cell(line, 1, "the frame number", cells.text());
  if (tally.time_s.empty())
    trial.first_frame = frame_number;
  else if (frame_number != expected)
    ++tally.frame_jumps;

  if (cells.next(number) != Cell::number || !std::isfinite(number))
    return bad_cell(line, 2, "the time", cells.text());
  tally.time_s.push_back(number);
  // Programs may write zero with fewer digits than the other times.
  if (number != 0.0) tally.resolution_s = std::min(tally.resolution_s, internal::resolution_of(cells.text()));
  return {};
}

/// Where blanks separate cells, one that is not there moves all others.
Status check_cells_in_blanks(std::string_view line, std::int64_t number, internal::Separator separator,
                             const TrcHeader& header) {
  if (separator != internal::Separator::blanks) return {};
  std::size_t found = 0;
  Cells cells(line, separator);
  for (std::string_view cell; cells.next_text(cell);) ++found;
  const std::size_t expected = 2 + 3 * header.marker.size();
  if (found >= expected) return {};
  return fail(
      Code::bad_input,
      fmt::format("line {}: holds {} cells between blanks; expected frame, time and {} coordinates. A "
                  "marker that is not seen needs tabs around its empty cells, or NaN",
                  number, found, expected - 2));
}

/// The coordinates of one row; `x` and `state` point at the row's first sample.
Status read_row_samples(Cells& cells, std::int64_t line, const TrcHeader& header, double* x,
                        data::SampleState* state, Tally& tally) {
  bool ended = false;
  for (std::size_t slot = 0; slot < header.marker.size(); ++slot) {
    const std::int32_t marker = header.marker[slot];
    std::array<double, 3> p{};
    int numbers = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t axis = header.axes.empty() ? k : header.axes[slot][k];
      const Cell kind = cells.next(p[axis]);
      if (kind == Cell::text && marker >= 0)
        return bad_cell(line, static_cast<std::int64_t>(3 + 3 * slot + k),
                        fmt::format("{} of marker '{}'", "xyz"[axis], excerpt(header.names[marker])),
                        cells.text());
      if (kind == Cell::number && !std::isnan(p[axis])) ++numbers;
      ended |= kind == Cell::none;
    }
    if (marker < 0) continue;
    bool seen = numbers == 3;
    if (!seen && numbers > 0) ++tally.part_blank;
    if (seen && !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) {
      ++tally.infinite;
      seen = false;
    }
    if (seen && internal::marks_missing(p[0], p[1], p[2])) {
      ++tally.marked;
      seen = false;
    }
    double* out = x + 3 * marker;
    if (seen) {
      ++tally.present[static_cast<std::size_t>(marker)];
      if (p[0] == 0.0 && p[1] == 0.0 && p[2] == 0.0) ++tally.zeros[static_cast<std::size_t>(marker)];
      for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = p[axis] / header.units_per_metre;
    } else {
      out[0] = out[1] = out[2] = kNaN;
    }
    state[marker] = seen ? data::SampleState::measured : data::SampleState::missing;
  }
  if (ended) {
    ++tally.short_rows;
    return {};
  }
  double ignored = 0.0;
  for (Cell kind = cells.next(ignored); kind != Cell::none; kind = cells.next(ignored))
    if (kind != Cell::blank) {
      ++tally.extra_rows;
      break;
    }
  return {};
}

/// "'A', 'B' and 3 more"
std::string list(const std::vector<std::string_view>& names) {
  std::vector<std::string> quoted;
  for (const auto name : names) quoted.push_back(fmt::format("'{}'", excerpt(name)));
  return join_some(quoted, kNamesInWarning);
}

/// Zeros out, and the warnings about markers.
void judge_markers(data::Trial& trial, const Tally& tally) {
  std::vector<std::string_view> blank;
  std::vector<std::string_view> always_zero;
  std::vector<std::string_view> sometimes_zero;
  std::int64_t zeros = 0;
  for (std::int64_t m = 0; m < trial.markers.markers(); ++m) {
    const auto i = static_cast<std::size_t>(m);
    if (tally.present[i] == 0) blank.push_back(trial.markers.names[i]);
    if (tally.zeros[i] == 0) continue;
    const std::int64_t removed = internal::remove_zeros(trial.markers, m);
    if (tally.zeros[i] == tally.present[i]) {
      always_zero.push_back(trial.markers.names[i]);
    } else if (removed > 0) {
      sometimes_zero.push_back(trial.markers.names[i]);
      zeros += removed;
    }
  }
  if (!blank.empty())
    trial.warnings.push_back(fmt::format("{} of {} markers have no sample in any frame: {}", blank.size(),
                                         trial.markers.names.size(), list(blank)));
  if (!always_zero.empty())
    trial.warnings.push_back(
        fmt::format("{} of {} markers are (0, 0, 0) in every frame, taken as not seen: {}",
                    always_zero.size(), trial.markers.names.size(), list(always_zero)));
  if (zeros > 0)
    trial.warnings.push_back(
        fmt::format("{} samples of {} markers are exactly (0, 0, 0), taken as not seen: {}", zeros,
                    sometimes_zero.size(), list(sometimes_zero)));
}

/// The warnings about rows.
void judge_rows(data::Trial& trial, const TrcHeader& header, const Tally& tally,
                std::int64_t next_text_line) {
  const std::int64_t rows = trial.markers.frames();
  const auto warn = [&](std::string sentence) { trial.warnings.push_back(std::move(sentence)); };
  if (header.frames && *header.frames != static_cast<double>(rows))
    warn(fmt::format("header says {} frames, {} rows are there; the rows are used", *header.frames, rows));
  if (next_text_line > 0)
    warn(fmt::format("a blank line ends the data; line {} and what follows is not read", next_text_line));
  if (tally.frame_jumps > 0)
    warn(fmt::format("frame numbers jump {} times; frames are counted from {} on", tally.frame_jumps,
                     trial.first_frame));
  if (tally.short_rows > 0)
    warn(fmt::format("{} of {} rows end before the last marker; the rest of them is taken as not seen",
                     tally.short_rows, rows));
  if (tally.extra_rows > 0)
    warn(fmt::format("{} of {} rows hold cells beyond the {} named markers; these are not read",
                     tally.extra_rows, rows, trial.markers.names.size()));
  if (tally.part_blank > 0)
    warn(fmt::format("{} samples have one or two blank coordinates, taken as not seen", tally.part_blank));
  if (tally.marked > 0)
    warn(fmt::format("{} samples are 999, 9999, ... in all coordinates, taken as not seen", tally.marked));
  if (tally.infinite > 0) warn(fmt::format("{} samples are infinite, taken as not seen", tally.infinite));
}

/// The clock of the rows, the first of which stands in line `first_line`.
Status settle_time(const TrcHeader& header, const Tally& tally, std::int64_t first_line,
                   std::int64_t most_frames, data::Trial& trial) {
  const auto place = [&](std::size_t row) {
    const auto i = static_cast<std::int64_t>(row);
    return fmt::format("line {} (frame {})", first_line + i, trial.first_frame + i);
  };
  const auto clock =
      internal::even_clock({.time_s = tally.time_s,
                            .resolution_s = std::isfinite(tally.resolution_s) ? tally.resolution_s : 0.0,
                            .stated = header.rates_hz,
                            .most_frames = most_frames,
                            .place = place},
                           trial.warnings);
  if (!clock) return std::unexpected(clock.error());
  internal::spread_rows(trial.markers, *clock);
  return {};
}

/// Of the units that an unknown word may mean, the one that makes the recording as large as a body.
Status settle_unit(const internal::TrcHeader& header, data::Trial& trial) {
  if (header.units_like.empty()) return {};
  const double extent = internal::largest_extent(trial.markers);
  const auto unit = unit_of_body_size(header.units_like, extent);
  if (!unit)
    return fail(
        Code::bad_input,
        fmt::format(
            "line {}: unit '{}' is unknown, and the markers, which reach over {:.4g} of it, do not tell "
            "which is meant; expected mm, cm or m",
            header.units_line, internal::excerpt(header.units), extent));
  for (double& coordinate : trial.markers.x_in_world) coordinate /= 1.0 / unit->metres;
  trial.warnings.push_back(
      fmt::format("line {}: unit '{}' is unknown; taken for {}, as the markers reach over {:.3g} m then",
                  header.units_line, internal::excerpt(header.units), unit->name, extent * unit->metres));
  return {};
}

Result<data::Trial> parse(std::string_view text) {
  Lines lines(text);
  auto header = internal::parse_trc_header(lines);
  if (!header) return std::unexpected(header.error());
  const auto rows = static_cast<std::size_t>(lines.count_until_blank());
  const std::size_t markers = header->names.size();
  if (rows == 0)
    return fail(Code::bad_input,
                fmt::format("line {}: the file ends before the first row of data", lines.number() + 1));
  const std::size_t most_frames = (text.size() / kSamplesPerByte + kSamplesAlways) / markers;
  if (rows > most_frames)
    return fail(Code::bad_input,
                fmt::format("line {}: {} rows for {} markers do not fit into the {} bytes of this file",
                            lines.number() + 1, rows, markers, text.size()));

  data::Trial trial;
  trial.format = "TRC";
  trial.units_in_file = header->units;
  trial.warnings = header->warnings;
  trial.markers.x_in_world.resize(3 * rows * markers);
  trial.markers.state.resize(rows * markers);
  Tally tally;
  tally.time_s.reserve(rows);
  tally.zeros.assign(markers, 0);
  tally.present.assign(markers, 0);

  std::int64_t frame_number = 0;
  std::string_view line;
  for (std::size_t row = 0; row < rows; ++row) {
    lines.next(line);
    const auto separator = internal::separator_of_row(line, header->separator);
    if (auto status = check_cells_in_blanks(line, lines.number(), separator, *header); !status)
      return std::unexpected(status.error());
    Cells cells(line, separator);
    if (auto status = read_row_start(cells, lines.number(), trial, tally, frame_number); !status)
      return std::unexpected(status.error());
    if (auto status = read_row_samples(cells, lines.number(), *header,
                                       trial.markers.x_in_world.data() + 3 * row * markers,
                                       trial.markers.state.data() + row * markers, tally);
        !status)
      return std::unexpected(status.error());
  }
  const std::int64_t first_line = lines.number() + 1 - static_cast<std::int64_t>(rows);
  const std::int64_t next_text_line = lines.skip_blank();

  trial.markers.names = std::move(header->names);
  trial.markers.time.frames = static_cast<std::int64_t>(rows);
  if (auto s = settle_unit(*header, trial); !s) return std::unexpected(s.error());
  judge_rows(trial, *header, tally, next_text_line);
  if (auto s = settle_time(*header, tally, first_line, static_cast<std::int64_t>(most_frames), trial); !s)
    return std::unexpected(s.error());
  judge_markers(trial, tally);
  return trial;
}

}  // namespace

Result<data::Trial> parse_trc(std::string_view text, std::string_view name) {
  auto trial = parse(text);
  if (!trial) return fail_at(name, trial.error());
  if (check_seal(text) == Seal::broken) trial->warnings.push_back(broken_seal());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_trc(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_trc(*text, path.string());
}

}  // namespace kinemark::io
