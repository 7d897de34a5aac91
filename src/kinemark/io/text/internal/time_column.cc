// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/time_column.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinemark/core/check.h"
#include "kinemark/io/rate.h"
#include "kinemark/math/statistics.h"

namespace kinemark::io::internal {
namespace {

constexpr double kJitterFrames = 0.02;       ///< an even column may jitter by this share of a frame
constexpr double kMaxRoundingFrames = 0.35;  ///< more is not rounding: a lost frame moves its rows by 1/2
constexpr double kSameMilliseconds = 0.01;   // of the steps that the header's rate has
constexpr double kSameRate = 1e-5;           ///< relative; headers round 59.94006 to 59.94

constexpr double kSlowestCamera = 5.0;   ///< Hz, of a header beside times that count 1 by 1
constexpr double kEvenStep = 0.2;        ///< share of the median by which steps of a table may differ
constexpr double kWholeMultiple = 0.25;  ///< frame intervals by which a hole may differ from a whole number

double time_of(std::size_t row, double rate_hz) { return static_cast<double>(row) / rate_hz; }

/// Half the range of  t_i - i / rate:  the largest error of an even column of this rate with its best start.
double spread(std::span<const double> time_s, double rate_hz) {
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double error = (time_s[i] - time_s[0]) - time_of(i, rate_hz);
    low = std::min(low, error);
    high = std::max(high, error);
  }
  return 0.5 * (high - low);
}

/// What rounding and jitter explain at this rate.
double tolerance(double resolution_s, double rate_hz) {
  return std::clamp(0.5 * resolution_s * 1.000001, kJitterFrames / rate_hz, kMaxRoundingFrames / rate_hz);
}

/// Least-squares slope of row number over time.
double fitted_rate(std::span<const double> time_s) {
  const auto n = static_cast<double>(time_s.size());
  double mean_s = 0.0;
  for (const double t : time_s) mean_s += (t - time_s[0]) / n;
  double sum_it = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    sum_it += (static_cast<double>(i) - 0.5 * (n - 1.0)) * ((time_s[i] - time_s[0]) - mean_s);
  return n * (n * n - 1.0) / 12.0 / sum_it;
}

/// The rate with the fewest decimals that describes the column as well as `rate_hz` does.
double rounded_rate(std::span<const double> time_s, double resolution_s, double rate_hz) {
  const double good_enough =
      std::max(0.5 * resolution_s * 1.000001, spread(time_s, rate_hz)) + 1e-6 / rate_hz;
  double scale = 1.0;
  for (int decimals = 0; decimals < 7; ++decimals, scale *= 10.0) {
    const double rounded = std::round(rate_hz * scale) / scale;
    if (rounded > 0.0 && spread(time_s, rounded) <= good_enough) return rounded;
  }
  return rate_hz;
}

double median_step(std::span<const double> time_s) {
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = time_s[i + 1] - time_s[i];
  return math::upper_median(steps);
}

/// Times written nearly as coarsely as frames follow each other, or more so, may repeat or leave out a step,
/// as an even clock at this rate does. Where both are the same, rounding moves nothing.
bool rounding_explains(const TimeColumn& column, double rate_hz) {
  const double coarseness = column.resolution_s * rate_hz;
  if (!(coarseness > 2.0 * kMaxRoundingFrames && coarseness <= 3.0) || std::abs(coarseness - 1.0) < 0.01)
    return false;
  return spread(column.time_s, rate_hz) <= 0.5 * column.resolution_s * 1.000001;
}

/// Every time is later than the one before.
Status check_increase(const TimeColumn& column) {
  const auto& t = column.time_s;
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i] > t[i - 1]) continue;
    const auto what = t[i] == t[i - 1]
                          ? fmt::format("time stands still at {:.9g} s", t[i])
                          : fmt::format("time goes back from {:.9g} to {:.9g} s", t[i - 1], t[i]);
    return fail(Code::bad_input,
                fmt::format("{}: {}; times must increase from row to row", column.place(i), what));
  }
  return {};
}

/// Frames from one row to the next; more than one: a hole. The one place that decides it.
double frames_of_step(double step_s, double interval_s) {
  return std::max(1.0, std::round(step_s / interval_s));
}

bool has_hole(std::span<const double> time_s, double interval_s) {
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (frames_of_step(time_s[i] - time_s[i - 1], interval_s) > 1.0) return true;
  return false;
}

/// Frame interval of the steps that are no holes, s.
double interval_without_holes(std::span<const double> time_s, double median_s) {
  double sum_s = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double step_s = time_s[i] - time_s[i - 1];
    if (frames_of_step(step_s, median_s) > 1.0) continue;
    sum_s += step_s;
    ++n;
  }
  return n == 0 ? median_s : sum_s / static_cast<double>(n);
}

/// The rate with the fewest decimals that puts the frames of the rows where `rate_hz` puts them.
double rounded_rate_of_frames(const TimeColumn& column, std::span<const std::int64_t> frame, double rate_hz) {
  const auto farthest_s = [&](double hz) {
    double worst_s = 0.0;
    for (std::size_t i = 0; i < frame.size(); ++i)
      worst_s = std::max(worst_s,
                         std::abs(column.time_s[i] - column.time_s[0] - static_cast<double>(frame[i]) / hz));
    return worst_s;
  };
  const double good_enough = std::max(column.resolution_s, farthest_s(rate_hz)) + 1e-6 / rate_hz;
  double scale = 1.0;
  for (int decimals = 0; decimals < 7; ++decimals, scale *= 10.0) {
    const double rounded = std::round(rate_hz * scale) / scale;
    if (rounded > 0.0 && farthest_s(rounded) <= good_enough) return rounded;
  }
  return rate_hz;
}

/// Frames of the rows of a column that has a hole at this interval.
/// @param stated_hz  a rate that agrees with the steps, or 0
Result<EvenClock> clock_with_holes(const TimeColumn& column, double interval_s, double stated_hz,
                                   std::vector<std::string>& warnings) {
  const auto& t = column.time_s;
  const double slack = std::min(kWholeMultiple + column.resolution_s / interval_s, 0.45);
  EvenClock clock;
  clock.frame.assign(1, 0);
  std::size_t holes = 0, first_hole = 0;
  double frame = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double steps = (t[i] - t[i - 1]) / interval_s;
    const double whole = frames_of_step(t[i] - t[i - 1], interval_s);
    if (whole > 1.0 && std::abs(steps - whole) > slack)
      return fail(
          Code::bad_input,
          fmt::format(
              "{}: time jumps from {:.9g} to {:.9g} s, {:.6g} frame intervals; expected one or a whole "
              "number of them",
              column.place(i), t[i - 1], t[i], steps));
    frame += whole;
    if (frame >= static_cast<double>(column.most_frames))
      return fail(
          Code::bad_input,
          fmt::format("{}: time jumps from {:.9g} to {:.9g} s; that is too long for the {} rows of this file",
                      column.place(i), t[i - 1], t[i], t.size()));
    if (whole > 1.0 && holes++ == 0) first_hole = i;
    clock.frame.push_back(static_cast<std::int64_t>(frame));
  }
  const auto missing = clock.frame.back() + 1 - static_cast<std::int64_t>(t.size());
  clock.time = {
      .rate_hz = stated_hz > 0.0 ? stated_hz : rounded_rate_of_frames(column, clock.frame, 1.0 / interval_s),
      .t0_s = t[0],
      .frames = clock.frame.back() + 1};
  warnings.push_back(
      fmt::format("the time column has {} {}, the first at {} ({:.9g} to {:.9g} s): {} {} missing "
                  "there and counted as such",
                  holes, holes == 1 ? "hole" : "holes", column.place(first_hole), t[first_hole - 1],
                  t[first_hole], missing, missing == 1 ? "frame is" : "frames are"));
  return clock;
}

/// A column whose steps are a thousand times those of the header's rate is in milliseconds.
Result<EvenClock> clock_of_milliseconds(const TimeColumn& column, std::vector<std::string>& warnings) {
  std::vector<double> seconds(column.time_s.begin(), column.time_s.end());
  for (double& t : seconds) t /= 1e3;
  auto scaled = column;
  scaled.time_s = seconds;
  scaled.resolution_s /= 1e3;
  warnings.emplace_back(
      "times are a thousand times those of the header's rate; they are taken for milliseconds");
  return even_clock(scaled, warnings);
}

/// Times that count 1 by 1, in whole numbers, are numbers of frames: no camera is as slow.
bool counts_frames(std::span<const double> time_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i)
    if (time_s[i] != std::floor(time_s[i]) || (i > 0 && time_s[i] != time_s[i - 1] + 1.0)) return false;
  return time_s.size() >= 3;
}

/// Such a column at the header's rate: frame 1, or 0 where it is the first, is at 0 s.
Result<EvenClock> clock_of_frames(const TimeColumn& column, double header_hz,
                                  std::vector<std::string>& warnings) {
  const double zero = column.time_s.front() >= 1.0 ? 1.0 : 0.0;
  warnings.push_back(
      fmt::format("times count frames, 1 by 1; the header's {:.6g} Hz gives them their seconds", header_hz));
  return EvenClock{.time = {.rate_hz = header_hz,
                            .t0_s = (column.time_s.front() - zero) / header_hz,
                            .frames = static_cast<std::int64_t>(column.time_s.size())},
                   .frame = {}};
}

}  // namespace

double resolution_of(std::string_view number) {
  const std::size_t exponent_at = number.find_first_of("eE");
  const std::string_view digits = number.substr(0, exponent_at);
  if (digits.find_first_not_of("+-.0123456789") != std::string_view::npos) return 0.0;
  double exponent = 0.0;
  if (exponent_at != std::string_view::npos)
    exponent = std::atoi(std::string(number.substr(exponent_at + 1, 8)).c_str());
  const std::size_t point = digits.find('.');
  if (point != std::string_view::npos) {
    // Trailing zeros carry no information: "0.017000" is rounded to 0.001.
    const std::size_t last = digits.find_last_not_of('0');
    exponent -= static_cast<double>(last - point);
  }
  return std::pow(10.0, exponent);
}

Result<EvenClock> even_clock(const TimeColumn& column, std::vector<std::string>& warnings) {
  const auto& time_s = column.time_s;
  const double resolution_s = column.resolution_s;
  check(!time_s.empty(), "even_clock() needs one row or more");
  EvenClock clock{.time = {.t0_s = time_s[0], .frames = static_cast<std::int64_t>(time_s.size())},
                  .frame = {}};
  TimeBase& time = clock.time;
  const auto first_stated = std::ranges::find_if(column.stated, is_rate);
  const double header_hz = first_stated == column.stated.end() ? 0.0 : *first_stated;
  if (time_s.size() == 1) {
    if (header_hz == 0.0)
      return fail(Code::bad_input, "the header gives no rate and a single row does not determine one");
    time.rate_hz = header_hz;
    return clock;
  }
  if (!rounding_explains(column, header_hz))
    if (auto s = check_increase(column); !s) return std::unexpected(s.error());
  if (header_hz > 0.0 && std::abs(1e-3 * median_step(time_s) * header_hz - 1.0) <
                             kSameMilliseconds + 0.5e-3 * resolution_s * header_hz)
    return clock_of_milliseconds(column, warnings);
  if (header_hz >= kSlowestCamera && counts_frames(time_s))
    return clock_of_frames(column, header_hz, warnings);

  for (const double rate_hz : column.stated) {
    if (!is_rate(rate_hz) || spread(time_s, rate_hz) > tolerance(resolution_s, rate_hz)) continue;
    time.rate_hz = rate_hz;
    if (rate_hz != header_hz)
      warnings.push_back(fmt::format("header says {} Hz, but the time column runs at {} Hz and is used",
                                     header_hz, rate_hz));
    return clock;
  }

  const double fit_hz = fitted_rate(time_s);
  if (is_rate(fit_hz) && spread(time_s, fit_hz) <= tolerance(resolution_s, fit_hz)) {
    time.rate_hz = rounded_rate(time_s, resolution_s, fit_hz);
    if (header_hz == 0.0)
      warnings.push_back(
          fmt::format("header gives no rate; {:.6g} Hz is taken from the time column", time.rate_hz));
    else if (std::abs(time.rate_hz - header_hz) > kSameRate * header_hz)
      warnings.push_back(fmt::format("header says {} Hz, but the time column runs at {:.6g} Hz and is used",
                                     header_hz, time.rate_hz));
    return clock;
  }

  // Uneven. The median step does not mind a lost frame or an odd last row.
  const double step_s = median_step(time_s);
  const double step_hz = step_s > 0.0 ? 1.0 / step_s : 0.0;
  if (!is_rate(step_hz) && !rounding_explains(column, header_hz))
    return fail(Code::bad_input,
                fmt::format("{}: rows are {:.6g} s apart; no camera takes frames at such a rate",
                            column.place(1), step_s));
  const bool header_agrees =
      header_hz > 0.0 && (!is_rate(step_hz) || std::abs(step_s - 1.0 / header_hz) <=
                                                   std::max(resolution_s, kJitterFrames / header_hz));
  const double interval_s = header_agrees ? 1.0 / header_hz : interval_without_holes(time_s, step_s);
  if (has_hole(time_s, interval_s) && !rounding_explains(column, header_hz))
    return clock_with_holes(column, interval_s, header_agrees ? header_hz : 0.0, warnings);
  time.rate_hz = header_agrees ? header_hz : rounded_rate(time_s, resolution_s, step_hz);
  std::size_t worst = 0;
  double deviation_s = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double error = std::abs((time_s[i] - time_s[0]) - time_of(i, time.rate_hz));
    if (error > deviation_s) {
      deviation_s = error;
      worst = i;
    }
  }
  warnings.push_back(fmt::format(
      "time column is uneven: row {} is at {:.6g} s, {:.6g} s off an even {:.6g} Hz{}; frames are "
      "taken as even",
      worst + 1, time_s[worst], deviation_s, time.rate_hz,
      header_agrees || header_hz == 0.0 ? "" : fmt::format(" (the header says {} Hz)", header_hz)));
  return clock;
}

void note_jump(const TimeColumn& column, std::vector<std::string>& warnings) {
  const auto& t = column.time_s;
  if (t.size() < 3) return;
  const double median_s = median_step(t);
  std::size_t even = 0, worst = 1;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step_s = t[i] - t[i - 1];
    even += std::abs(step_s - median_s) <= kEvenStep * median_s;
    if (step_s > t[worst] - t[worst - 1]) worst = i;
  }
  const bool is_even = even + 2 >= t.size() || 10 * even >= 9 * (t.size() - 1);
  if (!is_even || frames_of_step(t[worst] - t[worst - 1], median_s) <= 1.0) return;
  warnings.push_back(fmt::format("{}: time jumps from {:.9g} to {:.9g} s, elsewhere in steps of {:.6g} s",
                                 column.place(worst), t[worst - 1], t[worst], median_s));
}

}  // namespace kinemark::io::internal
