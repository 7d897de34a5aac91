// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <span>

#include "kinemark/core/index.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/internal/long_labels.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text/trajectories_csv.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using internal::excerpt;
using internal::split_csv;

constexpr double kMaxFrame = 1e15;

// What a column may be, in the order of `kNames`.
enum Kind : std::uint8_t {
  frame,
  time_s,
  marker,
  x,
  y,
  z,
  state,
  method,
  offset,
  sd_x,
  sd_y,
  sd_z,
  xy,
  xz,
  yz,
  filter,
  filter_order,
  filter_cutoff,
  filter_noise,
  raw_x,
  raw_y,
  raw_z,
  calibration,
  kinds
};
constexpr std::array<std::string_view, kinds> kNames = {"frame",
                                                        "time_s",
                                                        "marker",
                                                        "x_m",
                                                        "y_m",
                                                        "z_m",
                                                        "state",
                                                        "method",
                                                        "offset_s",
                                                        "sd_x_m",
                                                        "sd_y_m",
                                                        "sd_z_m",
                                                        "cov_xy_m2",
                                                        "cov_xz_m2",
                                                        "cov_yz_m2",
                                                        "filter",
                                                        "filter_order",
                                                        "filter_cutoff_hz",
                                                        "filter_noise_m",
                                                        "unfiltered_x_m",
                                                        "unfiltered_y_m",
                                                        "unfiltered_z_m",
                                                        "calibration_error"};

constexpr std::array kStates = {SampleState::missing,      SampleState::measured,  SampleState::interpolated,
                                SampleState::model_filled, SampleState::upsampled, SampleState::rejected};

constexpr std::size_t kShownColumns = 8;

/// One line of the file.
struct Sample {
  std::int64_t frame;
  std::int32_t marker;
  SampleState state;
  std::uint8_t method;
  std::array<double, 3> x;
  double offset_s;
};

/// Time of a frame by its first line, and the one that differs most from it.
struct FrameTime {
  double time_s;
  std::int64_t line;
  double other_s;
  std::int64_t other_line;
};

class Parser {
 public:
  Parser(data::Trial& trial, std::string_view unit) : trial_(trial), unit_(unit) {}

  Status header(std::string_view line) {
    if (!split_csv(line, cells_)) return fail(Code::bad_input, "line 1: a quote is not closed");
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const auto kind = std::ranges::find(kNames, cells_[c]);
      if (kind == kNames.end()) {
        trial_.warnings.push_back(fmt::format("column '{}' is not known and not read", excerpt(cells_[c])));
        continue;
      }
      auto& at = column_[static_cast<std::size_t>(kind - kNames.begin())];
      if (at) return fail(Code::bad_input, fmt::format("line 1: column '{}' occurs twice", *kind));
      at = c;
    }
    columns_ = cells_.size();
    if (const auto labels = internal::long_labels(cells_); labels.is_whole() && !is_own())
      return take_labels(labels);
    if (is_own() && !unit_.empty())
      return fail(
          Code::usage,
          "the file states the unit of its coordinates; one (--unit) is given only for tables of coordinates "
          "that state none");
    if (std::ranges::none_of(std::array{marker, x, y, z},
                             [&](Kind kind) { return column_[kind].has_value(); }))
      return fail(
          Code::bad_input,
          fmt::format(
              "line 1: none of its {} columns is a position of a marker. Need a time and columns such as "
              "LASI_X, LASI_Y, LASI_Z, or a line a sample with frame, time_s, marker, x_m, y_m and z_m",
              columns_));
    std::vector<std::string> absent;
    for (const Kind kind : {frame, time_s, marker, x, y, z})
      if (!column_[kind]) absent.push_back(fmt::format("'{}'", kNames[kind]));
    if (absent.empty()) return {};
    std::vector<std::string> labels;
    for (const auto& cell : cells_) labels.push_back(excerpt(cell));
    return fail(
        Code::bad_input,
        fmt::format("line 1: labels the columns {}; a table of one line a sample has frame, time_s, marker, "
                    "x_m, y_m and z_m, of which {} {} absent: call the columns so",
                    join_some(labels, kShownColumns), join_names(absent, absent.size()),
                    absent.size() == 1 ? "is" : "are"));
  }

  Status row(std::string_view line, std::int64_t number) {
    line_ = number;
    if (!split_csv(line, cells_)) return wrong("a quote is not closed");
    if (cells_.size() != columns_)
      return wrong(fmt::format("has {} cells; the header has {}", cells_.size(), columns_));
    error_.reset();
    Sample s{};
    const double time = number_in(time_s, true) / units_per_second_;
    const double frame_number = column_[frame] ? number_in(frame, true) : error_ ? kNaN : frame_at(time);
    s.x = {number_in(x) / units_per_metre_, number_in(y) / units_per_metre_, number_in(z) / units_per_metre_};
    s.offset_s = number_in(offset);
    const double sd[] = {number_in(sd_x), number_in(sd_y), number_in(sd_z)};
    const std::array<double, 6> covariance = {sd[0] * sd[0], number_in(xy), number_in(xz),
                                              sd[1] * sd[1], number_in(yz), sd[2] * sd[2]};
    const std::array<double, 3> raw = {number_in(raw_x), number_in(raw_y), number_in(raw_z)};
    const double filter_numbers[] = {number_in(filter_order), number_in(filter_cutoff),
                                     number_in(filter_noise)};
    if (error_) return wrong(*error_);
    if (frame_number != std::floor(frame_number) || std::abs(frame_number) > kMaxFrame)
      return wrong(fmt::format("frame {} is not a whole number", frame_number));
    s.frame = static_cast<std::int64_t>(frame_number);
    if (cells_[*column_[marker]].empty()) return wrong("names no marker");
    const auto [at, is_new] =
        markers_.try_emplace(cells_[*column_[marker]], static_cast<std::int32_t>(markers_.size()));
    if (is_new) {
      trial_.markers.names.push_back(name_of_bytes(at->first));
      if (trial_.markers.names.back().empty()) return wrong("names no marker");
    }
    s.marker = at->second;
    if (auto status = provenance(s); !status) return status;
    auto& of_frame = times_.try_emplace(s.frame, FrameTime{time, number, time, number}).first->second;
    if (std::abs(time - of_frame.time_s) > std::abs(of_frame.other_s - of_frame.time_s)) {
      of_frame.other_s = time;
      of_frame.other_line = number;
    }
    samples_.push_back(s);
    if (is_uncertain()) covariances_.push_back(covariance);
    if (keeps_unfiltered()) unfiltered_.push_back(raw);
    if (auto status = take_calibration(); !status) return status;
    return take_filter(filter_numbers, at->second, is_new);
  }

  Status finish();

 private:
  [[nodiscard]] std::unexpected<Error> wrong(const std::string& what) const {
    return fail(Code::bad_input, fmt::format("line {}: {}", line_, what));
  }

  /// Whether the columns are called as we call them.
  [[nodiscard]] bool is_own() const {
    return std::ranges::all_of(std::array{frame, time_s, marker, x, y, z},
                               [&](Kind kind) { return column_[kind].has_value(); });
  }

  /// The columns of a table whose labels are other people's.
  Status take_labels(const internal::LongLabels& labels) {
    trial_.warnings.clear();
    column_.fill(std::nullopt);
    column_[frame] = labels.frame;
    column_[time_s] = labels.time;
    column_[marker] = labels.marker;
    for (const auto& [kind, axis] : {std::pair{x, 0U}, {y, 1U}, {z, 2U}})
      column_[kind] = labels.coordinate[axis];
    const std::string_view unit = labels.unit.empty() ? unit_ : std::string_view(labels.unit);
    if (unit.empty())
      return fail(
          Code::bad_input,
          "line 1: no unit of length is stated; give it with --unit mm, cm or m, or in the labels: 'X (mm)'");
    const auto metres = metres_per_unit(unit);
    if (!metres)
      return fail(Code::bad_input,
                  fmt::format("line 1: length unit '{}' is unknown; expected mm, cm or m", excerpt(unit)));
    units_per_metre_ = 1.0 / *metres;
    units_per_second_ = labels.units_per_second;
    trial_.units_in_file = unit;
    std::vector<std::string> unread;
    for (std::size_t c = 0; c < cells_.size(); ++c)
      if (std::ranges::find(column_, std::optional(c)) == column_.end() && !cells_[c].empty())
        unread.push_back(fmt::format("'{}'", excerpt(cells_[c])));
    if (!unread.empty())
      trial_.warnings.push_back(
          fmt::format("columns that are not read: {}", join_some(unread, kShownColumns)));
    return {};
  }

  /// Of a table without frame numbers: times in the order in which they come.
  double frame_at(double time) {
    const auto count = static_cast<double>(frame_of_time_.size());
    return frame_of_time_.try_emplace(time, count + 1.0).first->second;
  }

  /// The number in a column, NaN where blank or where there is no such column.
  double number_in(Kind kind, bool needed = false) {
    if (!column_[kind]) return kNaN;
    const std::string& cell = cells_[*column_[kind]];
    if (cell.empty() && !needed) return kNaN;
    double value = kNaN;
    if (internal::parse_odd_number(cell, value) && (std::isfinite(value) || (!needed && std::isnan(value))))
      return value;
    error_ = fmt::format("{} is '{}'; need a number", kNames[kind], excerpt(cell));
    return kNaN;
  }

  [[nodiscard]] bool is_uncertain() const { return column_[sd_x] && column_[sd_y] && column_[sd_z]; }
  [[nodiscard]] bool keeps_unfiltered() const { return column_[raw_x] && column_[raw_y] && column_[raw_z]; }
  /// One line of the file has the error of the calibration.
  Status take_calibration() {
    if (!column_[calibration] || cells_[*column_[calibration]].empty()) return {};
    auto error = data::calibration_error_of(cells_[*column_[calibration]]);
    if (!error)
      return wrong("calibration_error holds no fields of displacement: need 13 numbers, then 60 for each");
    trial_.calibration_error = std::move(*error);
    return {};
  }
  /// Every line of a marker names the same filter.
  Status take_filter(std::span<const double, 3> numbers, std::int32_t of_marker, bool is_new) {
    if (!column_[filter]) return {};
    data::FilterUsed here{"none", 0, kNaN, kNaN};
    if (const std::string& name = cells_[*column_[filter]]; !name.empty()) {
      if (std::isfinite(numbers[0]) && !(std::abs(numbers[0]) <= 1000.0))
        return wrong(fmt::format("filter_order {} is no order of a filter", numbers[0]));
      here = {.method = name_of_bytes(name),
              .order = std::isfinite(numbers[0]) ? static_cast<int>(numbers[0]) : 0,
              .cutoff_hz = numbers[1],
              .noise_sd_m = numbers[2]};
    }
    auto& filters = trial_.markers.filters;
    if (is_new) {
      filters.push_back(std::move(here));
      return {};
    }
    const data::FilterUsed& first = filters[static_cast<std::size_t>(of_marker)];
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    if (here.method == first.method && here.order == first.order && same(here.cutoff_hz, first.cutoff_hz) &&
        same(here.noise_sd_m, first.noise_sd_m))
      return {};
    return wrong(fmt::format("marker '{}' has another filter than in its first line",
                             trial_.markers.names[static_cast<std::size_t>(of_marker)]));
  }
  /// As many frames as the lines may stand for.
  [[nodiscard]] std::int64_t most_frames() const {
    return static_cast<std::int64_t>((4 * samples_.size() + 1'000'000) / markers_.size());
  }
  Status settle_time();
  Status check_times_of_frames(const TimeBase& time) const;

  Status provenance(Sample& s) {
    const bool has_x = std::ranges::all_of(s.x, [](double v) { return std::isfinite(v); });
    s.state = has_x ? SampleState::measured : SampleState::missing;
    if (column_[state] && !cells_[*column_[state]].empty()) {
      const std::string& name = cells_[*column_[state]];
      const auto known =
          std::ranges::find_if(kStates, [&](SampleState k) { return data::to_string(k) == name; });
      if (known == kStates.end()) return wrong(fmt::format("'{}' is not a state", excerpt(name)));
      s.state = *known;
    }
    if (s.state == SampleState::missing || s.state == SampleState::rejected)
      s.x.fill(kNaN);
    else if (!has_x)
      return wrong(fmt::format("is {} but has not three coordinates", data::to_string(s.state)));
    if (!column_[method] || cells_[*column_[method]].empty()) return {};
    auto& methods = trial_.markers.methods;
    const std::string name = name_of_bytes(cells_[*column_[method]]);
    auto at = std::ranges::find(methods, name);
    if (at == methods.end()) {
      if (methods.size() == 255) return wrong("uses one method more than the 255 that are supported");
      at = methods.insert(methods.end(), name);
    }
    s.method = static_cast<std::uint8_t>(at - methods.begin() + 1);
    return {};
  }

  data::Trial& trial_;
  std::string_view unit_;  // that the user gives
  double units_per_metre_ = 1.0, units_per_second_ = 1.0;
  std::map<double, double> frame_of_time_;
  std::array<std::optional<std::size_t>, kinds> column_;
  std::size_t columns_ = 0;
  std::vector<std::string> cells_;
  std::int64_t line_ = 0;
  std::optional<std::string> error_;
  std::map<std::string, std::int32_t, std::less<>> markers_;
  std::map<std::int64_t, FrameTime> times_;  ///< of each frame
  std::vector<std::int64_t> clock_frame_;  ///< frame of the clock for each from the first on; empty: the same
  // Lists that grow without being copied: most of the memory that reading takes.
  std::deque<Sample> samples_;
  std::deque<std::array<double, 6>> covariances_;  ///< of each sample, where the file has deviations
  std::deque<std::array<double, 3>> unfiltered_;   ///< of each sample, where the file has them
};

/// Lines of one frame agree on its time to half a frame.
Status Parser::check_times_of_frames(const TimeBase& time) const {
  for (const auto& [number, at] : times_)
    if (std::abs(at.other_s - at.time_s) > 0.5 / time.rate_hz)
      return fail(Code::bad_input, fmt::format("line {}: frame {} is at {:.9g} s, in line {} at {:.9g} s",
                                               at.other_line, number, at.other_s, at.line, at.time_s));
  return {};
}

/// The clock of the frames. Frames without a line lie evenly between their neighbours.
Status Parser::settle_time() {
  const std::int64_t first = times_.begin()->first;
  data::Trajectories& t = trial_.markers;
  if (times_.size() == 1) {
    t.time = {.rate_hz = 1.0, .t0_s = times_.begin()->second.time_s, .frames = 1};
    trial_.warnings.emplace_back("a single frame does not determine a rate; 1 Hz is assumed");
    return check_times_of_frames(t.time);
  }
  std::vector<double> time_column;
  std::vector<std::int64_t> line;
  for (auto at = times_.begin(); at != times_.end(); ++at) {
    const auto next = std::next(at);
    const double steps = next == times_.end() ? 1.0 : static_cast<double>(next->first - at->first);
    for (double k = 0.0; k < steps; k += 1.0) {
      const double to_next_s = k == 0.0 ? 0.0 : next->second.time_s - at->second.time_s;
      time_column.push_back(at->second.time_s + k / steps * to_next_s);
      line.push_back(at->second.line);
    }
  }
  std::vector<std::string> notes;
  const auto place = [&](std::size_t row) {
    return fmt::format("line {} (frame {})", line[row], first + static_cast<std::int64_t>(row));
  };
  const auto clock = internal::even_clock({.time_s = time_column,
                                           .resolution_s = 0.0,
                                           .stated = {},
                                           .most_frames = most_frames(),
                                           .place = place},
                                          notes);
  if (!clock) return std::unexpected(clock.error());
  t.time = clock->time;
  clock_frame_ = clock->frame;
  // A CSV never states a rate; only what its clock does is worth a warning.
  for (std::string& warning : notes)
    if (!warning.starts_with("header gives no rate")) trial_.warnings.push_back(std::move(warning));
  return check_times_of_frames(t.time);
}

Status Parser::finish() {
  if (samples_.empty()) return fail(Code::bad_input, "has a header but no samples");
  const std::int64_t first = times_.begin()->first;
  const auto markers = static_cast<std::int64_t>(markers_.size());
  if (const auto stated = times_.rbegin()->first - first + 1; stated > most_frames())
    return fail(Code::bad_input, fmt::format("has frames from {} to {} and {} markers, but only {} lines",
                                             first, first + stated - 1, markers, samples_.size()));
  if (auto s = settle_time(); !s) return s;
  data::Trajectories& t = trial_.markers;
  const std::int64_t frames = t.time.frames;

  trial_.first_frame = first;
  const auto numbers = static_cast<std::size_t>(frames * markers);
  t.x_in_world.assign(3 * numbers, kNaN);
  t.state.assign(numbers, SampleState::missing);
  if (!t.methods.empty()) t.method.assign(numbers, 0);
  if (column_[offset]) t.sample_offset_s.assign(numbers, 0.0);
  if (is_uncertain()) t.covariance.assign(6 * numbers, kNaN);
  if (keeps_unfiltered()) t.unfiltered_in_world.assign(3 * numbers, kNaN);
  std::vector<bool> seen(numbers, false);
  auto covariance = covariances_.begin();
  auto unfiltered = unfiltered_.begin();
  for (const Sample& s : samples_) {
    const std::int64_t frame = clock_frame_.empty() ? s.frame - first : clock_frame_[at(s.frame - first)];
    const std::size_t i = t.index(frame, s.marker);
    if (seen[i])
      return fail(Code::bad_input, fmt::format("marker '{}' has two lines for frame {}",
                                               t.names[static_cast<std::size_t>(s.marker)], s.frame));
    seen[i] = true;
    std::ranges::copy(s.x, t.x_in_world.begin() + static_cast<std::ptrdiff_t>(3 * i));
    t.state[i] = s.state;
    if (!t.method.empty()) t.method[i] = s.method;
    if (!t.sample_offset_s.empty() && std::isfinite(s.offset_s)) t.sample_offset_s[i] = s.offset_s;
    if (keeps_unfiltered())
      std::ranges::copy(*unfiltered++, t.unfiltered_in_world.begin() + static_cast<std::ptrdiff_t>(3 * i));
    if (!is_uncertain()) continue;
    std::ranges::copy(*covariance++, t.covariance.begin() + static_cast<std::ptrdiff_t>(6 * i));
    // Standard deviations alone: axes that do not depend on each other.
    for (const auto& [k, kind] : {std::pair{1, xy}, {2, xz}, {4, yz}})
      if (!column_[kind]) t.covariance[6 * i + static_cast<std::size_t>(k)] = 0.0;
  }
  return trial_.validate();
}

}  // namespace

Result<data::Trial> parse_trajectories_csv(std::string_view text, const std::string& name,
                                           std::string_view unit) {
  data::Trial trial;
  trial.source = name;
  trial.format = "CSV";
  trial.units_in_file = "m";
  internal::Lines lines(text);
  std::string_view line;
  if (!lines.next(line)) return fail(Code::bad_input, name + ": is empty; expected a CSV of trajectories");
  if (auto status = internal::check_header_line(line, 1); !status) return fail_at(name, status.error());
  Parser parser(trial, unit);
  if (auto status = parser.header(line); !status) return fail_at(name, status.error());
  while (lines.next(line)) {
    if (internal::is_blank(line)) continue;
    if (auto status = parser.row(line, lines.number()); !status) return fail_at(name, status.error());
  }
  if (auto status = parser.finish(); !status) return fail_at(name, status.error());
  return trial;
}

Result<data::Trial> read_trajectories_csv(const std::filesystem::path& path, std::string_view unit) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_trajectories_csv(*text, path.string(), unit);
}

}  // namespace kinemark::io
