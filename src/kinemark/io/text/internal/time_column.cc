// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/time_column.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"

namespace kinemark::io::internal {
namespace {

constexpr double kJitterFrames = 0.02;       ///< an even column may jitter by this share of a frame
constexpr double kMaxRoundingFrames = 0.35;  ///< more is not rounding: a lost frame moves its rows by 1/2
constexpr double kSameRate = 1e-5;           ///< relative; headers round 59.94006 to 59.94

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

bool usable(double rate_hz) { return rate_hz > 0.0 && std::isfinite(rate_hz); }

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

Result<TimeBase> even_time(std::span<const double> time_s, double resolution_s,
                           std::span<const double> stated, std::vector<std::string>& warnings) {
  check(!time_s.empty(), "even_time() needs one row or more");
  TimeBase time{.t0_s = time_s[0], .frames = static_cast<std::int64_t>(time_s.size())};
  const auto first_stated = std::ranges::find_if(stated, usable);
  const double header_hz = first_stated == stated.end() ? 0.0 : *first_stated;
  if (time_s.size() == 1) {
    if (header_hz == 0.0)
      return fail(Code::bad_input, "the header gives no rate and a single row does not determine one");
    time.rate_hz = header_hz;
    return time;
  }

  for (const double rate_hz : stated) {
    if (!usable(rate_hz) || spread(time_s, rate_hz) > tolerance(resolution_s, rate_hz)) continue;
    time.rate_hz = rate_hz;
    if (rate_hz != header_hz)
      warnings.push_back(fmt::format("header says {} Hz, but the time column runs at {} Hz and is used",
                                     header_hz, rate_hz));
    return time;
  }

  const double fit_hz = fitted_rate(time_s);
  if (usable(fit_hz) && spread(time_s, fit_hz) <= tolerance(resolution_s, fit_hz)) {
    time.rate_hz = rounded_rate(time_s, resolution_s, fit_hz);
    if (header_hz == 0.0)
      warnings.push_back(
          fmt::format("header gives no rate; {:.6g} Hz is taken from the time column", time.rate_hz));
    else if (std::abs(time.rate_hz - header_hz) > kSameRate * header_hz)
      warnings.push_back(fmt::format("header says {} Hz, but the time column runs at {:.6g} Hz and is used",
                                     header_hz, time.rate_hz));
    return time;
  }

  // Uneven. The median step does not mind a lost frame or an odd last row.
  const double step_s = median_step(time_s);
  const double step_hz = 1.0 / step_s;
  const bool step_usable = step_s > 0.0 && usable(step_hz);
  if (!step_usable && header_hz == 0.0)
    return fail(Code::bad_input, "the header gives no rate and the time column does not increase");
  const bool header_agrees =
      header_hz > 0.0 && (!step_usable || std::abs(step_s - 1.0 / header_hz) <=
                                              std::max(resolution_s, kJitterFrames / header_hz));
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
  return time;
}

}  // namespace kinemark::io::internal
