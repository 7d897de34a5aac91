// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/sample_clock.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/io/rate.h"

namespace kinemark::io {
namespace {

constexpr double kLongestSpan_s =
    1e9;  // a recorder's clock counts seconds since a machine was started, or since 1970
constexpr std::int64_t kMostDroppedPerSample = 10;
constexpr double kSdOfMad = 1.4826;

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// y = mean_y + slope (x - mean_x), least squares.
struct Line {
  double mean_x = 0.0, mean_y = 0.0, slope = 0.0;
  [[nodiscard]] double at(double x) const { return mean_y + slope * (x - mean_x); }
};

template <class X, class Y>
Line fit(std::size_t count, X x, Y y) {
  Line out;
  for (std::size_t i = 0; i < count; ++i) {
    out.mean_x += x(i) / static_cast<double>(count);
    out.mean_y += y(i) / static_cast<double>(count);
  }
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    xx += (x(i) - out.mean_x) * (x(i) - out.mean_x);
    xy += (x(i) - out.mean_x) * (y(i) - out.mean_y);
  }
  out.slope = xx > 0.0 ? xy / xx : 0.0;
  return out;
}

/// Samples without a time come a step after the one before; the first ones, before the first that has one.
Status fill_times(double step_s, std::vector<double>& time_s) {
  const auto known = std::ranges::find_if(time_s, [](double t) { return std::isfinite(t); });
  if (known == time_s.end()) return fail(Code::bad_input, "no sample has a time");
  for (auto t = known; t != time_s.begin(); --t) *(t - 1) = *t - step_s;
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (!std::isfinite(time_s[i])) time_s[i] = time_s[i - 1] + step_s;
  return {};
}

}  // namespace

void correct_clock(std::span<const std::pair<double, double>> offsets, std::vector<double>& time_s) {
  std::vector<std::pair<double, double>> good;
  for (const auto& [when, offset] : offsets)
    if (std::abs(when) < kLongestSpan_s * 10 && std::abs(offset) < kLongestSpan_s * 10)
      good.emplace_back(when, offset);
  if (good.empty()) return;
  const Line line = fit(
      good.size(), [&](std::size_t i) { return good[i].first; },
      [&](std::size_t i) { return good[i].second; });
  for (double& t : time_s) t += line.at(t);
}

Result<SampleClock> find_clock(std::vector<double> time_s, double nominal_hz) {
  if (time_s.empty()) return fail(Code::bad_input, "the stream holds no sample");
  const bool stated = is_rate(nominal_hz);
  if (auto s = fill_times(stated ? 1.0 / nominal_hz : 0.0, time_s); !s) return std::unexpected(s.error());
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  const double rate_hz = stated ? nominal_hz : steps.empty() ? 0.0 : 1.0 / median(steps);
  if (!is_rate(rate_hz)) return fail(Code::bad_input, "the stream has no rate, and its times tell none");
  const auto no_step = [](double step) { return !(std::abs(step) < kLongestSpan_s); };
  if (std::ranges::any_of(steps, no_step))
    return fail(Code::bad_input, "the times of the stream make no sense");

  SampleClock out{.rate_hz = rate_hz, .start_s = time_s.front(), .frame = {0}};
  std::vector<double> off;
  for (const double step : steps) off.push_back(std::abs(step - 1.0 / rate_hz));
  const double widest = 1.5 / rate_hz + (off.empty() ? 0.0 : 6.0 * kSdOfMad * median(off));
  for (const double step : steps) {
    std::int64_t frames = 1;
    if (step > widest) {
      frames = std::llround(step * rate_hz);
      out.widest_gap_s = std::max(out.widest_gap_s, step);
    }
    out.dropped += frames - 1;
    out.frame.push_back(out.frame.back() + frames);
    if (out.dropped > kMostDroppedPerSample * std::ssize(time_s))
      return fail(
          Code::bad_input,
          fmt::format("{} frames and more are without a sample beside {} with one; expected an even stream",
                      out.dropped, time_s.size()));
  }
  if (time_s.size() < 2) return out;

  const double first_s = time_s.front();
  const Line line = fit(
      time_s.size(), [&](std::size_t i) { return static_cast<double>(out.frame[i]); },
      [&](std::size_t i) { return time_s[i] - first_s; });
  const auto last = static_cast<double>(out.frame.back());
  if (!(line.slope > 0.0) || !is_rate(1.0 / line.slope))
    return fail(Code::bad_input, "the times of the stream go back");
  if (std::abs(line.slope * rate_hz - 1.0) * last > 0.5 || !stated) out.rate_hz = 1.0 / line.slope;
  // The line's middle is best known; its beginning by the rate chosen.
  out.start_s = first_s + line.mean_y - line.mean_x / out.rate_hz;
  return out;
}

}  // namespace kinemark::io
