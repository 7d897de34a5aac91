// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/cycle_curves.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

constexpr double kLongestStep = 2.0;  // median steps between neighbours

double median_step(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) steps.push_back(time_s[i + 1] - time_s[i]);
  return math::median(steps);
}

// Linear between the neighbours of a time; NaN where one is not there.
double value_at(const CycleSeries& series, const std::vector<double>& values, double step_s, double time_s) {
  const auto& t = series.time_s;
  if (t.empty() || !(time_s >= t.front() && time_s <= t.back())) return kNaN;
  const auto after = std::max<std::int64_t>(1, std::ranges::lower_bound(t, time_s) - t.begin());
  if (after >= std::ssize(t)) return time_s == t.front() ? values.front() : kNaN;
  const std::size_t b = at(after), a = b - 1;
  if (time_s == t[a]) return values[a];
  if (time_s == t[b]) return values[b];
  if (t[b] - t[a] > kLongestStep * step_s) return kNaN;
  const double later = (time_s - t[a]) / (t[b] - t[a]);
  return (1.0 - later) * values[a] + later * values[b];
}

}  // namespace

data::CycleCurves cut_into_cycles(const CycleSeries& series, std::span<const GaitCycle> cycles,
                                  data::Side side, std::int64_t points) {
  check(points >= 2, "a curve has two points or more");
  check(series.values.size() == series.time_s.size() &&
            (series.sd.empty() || series.sd.size() == series.values.size()),
        "a series has a value, and a deviation or none, for each time");
  data::CycleCurves out{.id = series.id,
                        .subject = {},
                        .context = std::string(data::to_string(side)),
                        .quantity = series.quantity,
                        .points = points,
                        .cycles = {},
                        .values = {},
                        .sd = {}};
  const double step = median_step(series.time_s);
  for (const auto& cycle : cycles) {
    if (cycle.side != side) continue;
    out.cycles.push_back(fmt::format("{} {}", data::to_string(side), out.cycles.size() + 1));
    for (std::int64_t p = 0; p < points; ++p) {
      const double share = static_cast<double>(p) / static_cast<double>(points - 1);
      const double t = cycle.start_s + share * (cycle.end_s - cycle.start_s);
      out.values.push_back(value_at(series, series.values, step, t));
      if (!series.sd.empty()) out.sd.push_back(value_at(series, series.sd, step, t));
    }
  }
  return out;
}

MeanCurve mean_of_cycles(const data::CycleCurves& curves) {
  MeanCurve out;
  for (std::int64_t p = 0; p < curves.points; ++p) {
    double sum = 0.0, squares = 0.0;
    std::int64_t count = 0;
    for (std::int64_t c = 0; c < curves.count(); ++c)
      if (const double x = curves(c, p); std::isfinite(x)) sum += x, ++count;
    const double mean = count > 0 ? sum / static_cast<double>(count) : kNaN;
    for (std::int64_t c = 0; c < curves.count(); ++c)
      if (const double x = curves(c, p); std::isfinite(x)) squares += (x - mean) * (x - mean);
    out.mean.push_back(mean);
    out.sd.push_back(count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : kNaN);
    out.cycles.push_back(count);
  }
  return out;
}

}  // namespace kinemark::analysis
