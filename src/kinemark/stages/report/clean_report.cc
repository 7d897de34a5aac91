// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/clean_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "kinemark/core/check.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/report/internal/base64.h"
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/page.h"
#include "kinemark/stages/report/internal/plot_points.h"

namespace kinemark::report {

namespace {

using Json = nlohmann::ordered_json;
using data::Trajectories;
using internal::base64;
using internal::PlotPoints;

/// Gaps and defects in a page; its tables and its size stay usable.
constexpr std::size_t kMostListed = 3000;

/// Points so that all markers of a recording stay within the page: per marker and point eight triples of
/// floats and two states. Base64 adds a third.
PlotPoints plot_grid(const TimeBase& time, std::int64_t markers, const ReportOptions& options) {
  check(options.check().has_value(), "report options are out of range");
  const std::int64_t bytes = (8 * 3 * 4 + 2) * markers * 4 / 3 + 1;
  return {time.frames,
          std::max<std::int64_t>(2, std::min(options.max_points, options.max_series_bytes / bytes))};
}

/// Element (frame, marker, k) of an array of F x markers x width, for all frames.
void gather(std::span<const double> array, std::int64_t markers, std::int64_t marker, std::int64_t width,
            std::int64_t k, std::vector<double>& out) {
  const auto stride = static_cast<std::size_t>(markers * width);
  std::size_t at = static_cast<std::size_t>(marker * width + k);
  for (double& value : out) {
    value = array[at];
    at += stride;
  }
}

/// Nothing at all is no series.
bool any_finite(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double v) { return std::isfinite(v); });
}

std::array<std::int64_t, 6> count_states(const Trajectories& t, std::int64_t marker,
                                         std::vector<std::uint8_t>& codes) {
  std::array<std::int64_t, 6> counts{};
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    const data::SampleState state = t.state[t.index(f, marker)];
    ++counts[static_cast<std::size_t>(state)];
    codes[static_cast<std::size_t>(f)] = internal::state_rank(state);
  }
  return counts;
}

/// One marker's series are gathered here one at a time from the frame-first arrays.
struct Gatherer {
  const PlotPoints& points;
  std::int64_t markers, marker;
  std::vector<double> column;

  void values(std::span<const double> array, std::array<std::vector<float>, 3>& out) {
    if (array.empty()) return;
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      gather(array, markers, marker, 3, axis, column);
      if (any_finite(column)) out[static_cast<std::size_t>(axis)] = points.extremes(column);
    }
  }
  void deviations(std::span<const double> array, std::array<std::vector<float>, 3>& out) {
    if (array.empty()) return;
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      gather(array, markers, marker, 3, axis, column);
      if (any_finite(column)) out[static_cast<std::size_t>(axis)] = points.largest(column);
    }
  }
  /// What came in less the result; nothing where one of them has no coordinates.
  void change(const Trajectories& before, std::int64_t before_marker, const Trajectories& after,
              std::array<std::vector<float>, 3>& out) {
    std::vector<double> raw(column.size());
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      gather(before.x_in_world, before.markers(), before_marker, 3, axis, raw);
      gather(after.x_in_world, markers, marker, 3, axis, column);
      std::ranges::transform(raw, column, column.begin(), std::minus{});
      if (any_finite(column)) out[static_cast<std::size_t>(axis)] = points.extremes(column);
    }
  }
  /// Square roots of the diagonals.
  void variances(std::span<const double> array, std::array<std::vector<float>, 3>& out) {
    if (array.empty()) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      gather(array, markers, marker, 6, static_cast<std::int64_t>(math::kSymmetric3Diagonal[axis]), column);
      for (double& v : column) v = std::sqrt(v);
      if (any_finite(column)) out[axis] = points.largest(column);
    }
  }
};

Json axes_json(const std::array<std::vector<float>, 3>& axes, float scale) {
  Json out = Json::array();
  for (const std::vector<float>& axis : axes) {
    if (axis.empty()) {
      out.push_back(nullptr);
      continue;
    }
    std::vector<float> scaled(axis.size());
    std::ranges::transform(axis, scaled.begin(), [scale](float v) { return scale * v; });
    out.push_back(base64(scaled));
  }
  return out;
}

Json series_json(const CleanSeries& s) {
  constexpr float kMmPerM = 1e3F;
  return {{"raw_mm", axes_json(s.raw, kMmPerM)},
          {"position_mm", axes_json(s.position, kMmPerM)},
          {"position_sd_mm", axes_json(s.position_sd, kMmPerM)},
          {"change_mm", axes_json(s.change, kMmPerM)},
          {"velocity", axes_json(s.velocity, 1.0F)},
          {"velocity_sd", axes_json(s.velocity_sd, 1.0F)},
          {"acceleration", axes_json(s.acceleration, 1.0F)},
          {"acceleration_sd", axes_json(s.acceleration_sd, 1.0F)},
          {"before", base64(s.before)},
          {"after", base64(s.after)}};
}

/// Only the longest of an array of things that last for some frames; the others keep their order.
void keep_longest(Json& list) {
  if (list.size() <= kMostListed) return;
  const auto frames = [&](std::size_t i) {
    return list[i]["last_frame"].get<std::int64_t>() - list[i]["first_frame"].get<std::int64_t>();
  };
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    const std::int64_t x = frames(a), y = frames(b);
    return x != y ? x > y : a < b;
  });
  order.resize(kMostListed);
  std::ranges::sort(order);
  Json kept = Json::array();
  for (const std::size_t i : order) kept.push_back(std::move(list[i]));
  list = std::move(kept);
}

}  // namespace

void add_marker(CleanReport& report, data::MarkerAccount account, const MarkerArrays& arrays,
                const ReportOptions& options) {
  check(arrays.before != nullptr && arrays.after != nullptr, "a marker's report needs it before and after");
  const Trajectories &before = *arrays.before, &after = *arrays.after;
  check(before.frames() == report.time.frames && after.frames() == report.time.frames,
        "a marker's report needs the frames of the report");
  check(arrays.before_marker >= 0 && arrays.before_marker < before.markers() && arrays.after_marker >= 0 &&
            arrays.after_marker < after.markers(),
        "a marker's report needs a marker that exists");

  const PlotPoints points = plot_grid(report.time, before.markers(), options);
  const auto frames = static_cast<std::size_t>(report.time.frames);
  CleanSeries series{.points = points.size(), .frame_step = points.step()};
  std::vector<std::uint8_t> codes(frames, 0);
  CleanCounts counts;
  counts.before = count_states(before, arrays.before_marker, codes);
  series.before = points.worst(codes);
  counts.after = count_states(after, arrays.after_marker, codes);
  series.after = points.worst(codes);

  Gatherer raw{points, before.markers(), arrays.before_marker, std::vector<double>(frames)};
  raw.values(before.x_in_world, series.raw);
  Gatherer result{points, after.markers(), arrays.after_marker, std::move(raw.column)};
  result.values(after.x_in_world, series.position);
  result.variances(after.covariance, series.position_sd);
  result.change(before, arrays.before_marker, after, series.change);
  if (const data::Derivatives* d = arrays.derivatives; d != nullptr) {
    check(d->velocity.empty() || d->velocity.size() == after.x_in_world.size(),
          "a marker's report needs derivatives of the result");
    result.values(d->velocity, series.velocity);
    result.deviations(d->velocity_sd, series.velocity_sd);
    result.values(d->acceleration, series.acceleration);
    result.deviations(d->acceleration_sd, series.acceleration_sd);
  }
  report.account.markers.push_back(std::move(account));
  report.counts.push_back(counts);
  report.series.push_back(std::move(series));
}

nlohmann::ordered_json clean_report_json(const CleanReport& report) {
  check(report.series.size() == report.account.markers.size(),
        "add_marker() makes a report's markers and series");
  const bool alike = std::ranges::all_of(report.series, [&](const CleanSeries& s) {
    return s.points == report.series.front().points && s.frame_step == report.series.front().frame_step;
  });
  check(alike, "all markers of a page need the same points: the same recording and the same options");
  Json summary = clean_summary_json(report);
  keep_longest(summary["gaps"]);
  keep_longest(summary["defects"]);
  Json markers = Json::array();
  for (const CleanSeries& s : report.series) markers.push_back(series_json(s));
  const bool none = report.series.empty();
  return {{"summary", std::move(summary)},
          {"series",
           {{"frame_step", none ? 1 : report.series.front().frame_step},
            {"points", none ? 0 : report.series.front().points},
            {"markers", std::move(markers)}}}};
}

std::string clean_report_html(const CleanReport& report) {
  return internal::fill_page(clean_report_json(report));
}

}  // namespace kinemark::report
