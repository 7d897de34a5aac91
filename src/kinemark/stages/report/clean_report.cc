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
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/curve_block.h"
#include "kinemark/stages/report/internal/page.h"
#include "kinemark/stages/report/internal/plot_points.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report {

namespace {

using Json = nlohmann::ordered_json;
using data::Trajectories;
using internal::PlotPoints;

/// Gaps and defects in a page; its tables and its size stay usable.
constexpr std::size_t kMostListed = 3000;

/// Numbers that curves of all markers may hold before they are packed; bounds the memory.
constexpr std::int64_t kMostNumbers = 6'000'000;

/// Places that all markers may have together in space, and what they may take of a page whose curves are
/// thinned: extremes of axes were never together.
constexpr std::int64_t kMostPositions = 200'000;
constexpr std::int64_t kPositionsBytes = 250'000;
constexpr std::int64_t kPositionsShare = 8;  // and at most so small a part of all

/// Points of the curves before they are packed: per marker eight triples.
PlotPoints plot_grid(const TimeBase& time, std::int64_t markers, const ReportOptions& options) {
  check(options.check().has_value(), "report options are out of range");
  const std::int64_t most = kMostNumbers / (24 * std::max<std::int64_t>(1, markers));
  return {time.frames, std::max<std::int64_t>(2, std::min(options.max_points, most))};
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

using Axes = std::array<std::vector<float>, 3>;

std::vector<float> scaled(const std::vector<float>& values, float scale) {
  std::vector<float> out(values.size());
  std::ranges::transform(values, out.begin(), [scale](float v) { return scale * v; });
  return out;
}

/// One packed curve an axis; null where there is none.
Json pack_axes(const Axes& axes, const Axes& sd, float scale, double usual_step, const PlotPoints& thinned) {
  Json out = Json::array();
  for (std::size_t k = 0; k < 3; ++k) {
    if (axes[k].empty()) {
      out.push_back(nullptr);
      continue;
    }
    const auto values = thinned.extremes(scaled(axes[k], scale));
    const double step = internal::curve_step(values, scaled(sd[k], scale), usual_step);
    out.push_back(internal::pack_curve(values, step));
  }
  return out;
}

Json pack_deviations(const Axes& axes, float scale, const PlotPoints& thinned) {
  Json out = Json::array();
  for (const auto& axis : axes) {
    if (axis.empty()) {
      out.push_back(nullptr);
      continue;
    }
    out.push_back(internal::pack_deviations(thinned.largest(scaled(axis, scale))));
  }
  return out;
}

/// Whether what came in is position and change together, wherever it is there.
bool is_sum(const CleanSeries& s, std::size_t axis) {
  if (s.frame_step != 1 || s.position[axis].empty() || s.change[axis].empty()) return false;
  for (std::size_t i = 0; i < s.raw[axis].size(); ++i)
    if (std::isfinite(s.raw[axis][i]) != std::isfinite(s.change[axis][i])) return false;
  return true;
}

Json pack_marker(const CleanSeries& s, const PlotPoints& thinned) {
  constexpr float kMmPerM = 1e3F;
  // No number is written twice.
  Json raw = pack_axes(s.raw, s.position_sd, kMmPerM, internal::kUsualStep_mm, thinned);
  for (std::size_t k = 0; k < 3; ++k)
    if (thinned.step() == 1 && is_sum(s, k)) raw[k] = {{"kind", "sum"}};
  return {{"raw_mm", std::move(raw)},
          {"position_mm", pack_axes(s.position, s.position_sd, kMmPerM, internal::kUsualStep_mm, thinned)},
          {"position_sd_mm", pack_deviations(s.position_sd, kMmPerM, thinned)},
          {"change_mm", pack_axes(s.change, s.position_sd, kMmPerM, internal::kUsualStep_mm, thinned)},
          {"velocity", pack_axes(s.velocity, s.velocity_sd, 1.0F, internal::kUsualStep_m_s, thinned)},
          {"velocity_sd", pack_deviations(s.velocity_sd, 1.0F, thinned)},
          {"acceleration",
           pack_axes(s.acceleration, s.acceleration_sd, 1.0F, internal::kUsualStep_m_s2, thinned)},
          {"acceleration_sd", pack_deviations(s.acceleration_sd, 1.0F, thinned)},
          {"before", internal::pack_codes(thinned.worst(s.before))},
          {"after", internal::pack_codes(thinned.worst(s.after))}};
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

/// The result in space, in evenly chosen frames as they are.
Json positions_json(const CleanReport& report, std::int64_t most_bytes) {
  const std::int64_t step = report.series.front().place_step;
  std::vector<std::string> names;
  for (const auto& marker : report.account.markers) names.push_back(marker.name);
  const auto points = std::ssize(report.series.front().positions);
  auto positions =
      Trajectories::all_missing(names, {.rate_hz = report.time.rate_hz / static_cast<double>(step),
                                        .t0_s = report.time.t0_s,
                                        .frames = points});
  for (std::int64_t m = 0; m < positions.markers(); ++m) {
    const auto& series = report.series[static_cast<std::size_t>(m)];
    for (std::int64_t p = 0; p < points; ++p) {
      const auto i = static_cast<std::size_t>(p);
      positions.state[positions.index(p, m)] = series.place_state[i];
      positions.x(p, m) = series.positions[i].cast<double>();
    }
  }
  Json out = scene_json({.markers = &positions, .up = {}, .up_from = ""},
                        {.max_bytes = most_bytes, .max_bytes_long = most_bytes, .short_frames = 0});
  out["frame_step"] = step * out["frame_step"].get<std::int64_t>();
  out["worst"] = nullptr;  // of every frame, which the map of gaps shows
  return out;
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
  const std::int64_t most = kMostPositions / std::max<std::int64_t>(1, before.markers());
  series.place_step =
      std::max<std::int64_t>(1, (after.frames() + most - 1) / std::max<std::int64_t>(1, most));
  for (std::int64_t f = 0; f < after.frames(); f += series.place_step) {
    series.positions.emplace_back(after.x(f, arrays.after_marker).cast<float>());
    series.place_state.push_back(after.state[after.index(f, arrays.after_marker)]);
  }
  report.account.markers.push_back(std::move(account));
  report.counts.push_back(counts);
  report.series.push_back(std::move(series));
}

nlohmann::ordered_json clean_report_json(const CleanReport& report, const ReportOptions& options) {
  check(options.check().has_value(), "report options are out of range");
  check(report.series.size() == report.account.markers.size(),
        "add_marker() makes a report's markers and series");
  const bool alike = std::ranges::all_of(report.series, [&](const CleanSeries& s) {
    return s.points == report.series.front().points && s.frame_step == report.series.front().frame_step;
  });
  check(alike, "all markers of a page need the same points: the same recording and the same options");
  Json summary = clean_summary_json(report);
  keep_longest(summary["gaps"]);
  keep_longest(summary["defects"]);
  const bool none = report.series.empty();
  const std::int64_t points = none ? 0 : report.series.front().points;
  const std::int64_t step = none ? 1 : report.series.front().frame_step;
  const auto curves_within = [&](std::int64_t most_bytes) {
    return internal::pack_within(points, most_bytes, [&](const PlotPoints& thinned) {
      Json markers = Json::array();
      for (const CleanSeries& s : report.series) markers.push_back(pack_marker(s, thinned));
      return Json{
          {"frame_step", step * thinned.step()}, {"points", thinned.size()}, {"markers", std::move(markers)}};
    });
  };
  const auto is_thinned = [](const Json& series) { return series["frame_step"].get<std::int64_t>() > 1; };
  const std::int64_t positions_bytes =
      std::clamp<std::int64_t>(options.max_data_bytes / kPositionsShare, 1000, kPositionsBytes);
  Json series = curves_within(options.max_data_bytes - (step > 1 ? positions_bytes : 0));
  Json scene = nullptr;
  if (is_thinned(series)) {
    if (step == 1) series = curves_within(options.max_data_bytes - positions_bytes);
    scene = positions_json(report, positions_bytes);
  }
  return {{"summary", std::move(summary)}, {"series", std::move(series)}, {"scene", std::move(scene)}};
}

std::string clean_report_html(const CleanReport& report, const ReportOptions& options) {
  return internal::fill_page(clean_report_json(report, options));
}

}  // namespace kinemark::report
