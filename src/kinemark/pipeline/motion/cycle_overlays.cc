// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"
#include "kinemark/stages/analysis/gait/gait_events.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

#include "kinemark/pipeline/motion/internal/cycle_overlays.h"

namespace kinemark::pipeline::internal {
namespace {

analysis::CycleSeries series_of(const data::JointMotion& motion, std::int64_t coordinate) {
  analysis::CycleSeries out{
      .id = motion.coordinates[at(coordinate)],
      .quantity = motion.is_rotation[at(coordinate)] ? data::Quantity::angle : data::Quantity::length};
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto i = motion.index(f, coordinate);
    const bool determined = motion.determined.empty() || motion.determined[i] != 0;
    out.time_s.push_back(motion.time.time_s(f));
    out.values.push_back(determined ? motion.q[i] : kNaN);
  }
  return out;
}

// What is held fixed has no curve.
bool moves(const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  return high > low;
}

bool is_of_other_foot(std::string_view name, data::Side side) {
  return name.ends_with(side == data::Side::left ? "_r" : "_l");
}

/// In time alone: nothing is asked of where the feet are.
std::vector<analysis::GaitCycle> cycles_of(std::span<const data::Event> events, const TimeBase& recording) {
  return analysis::find_cycles({}, analysis::events_of_file(events, recording).events,
                               Eigen::RowVector2d::Zero());
}

}  // namespace

std::vector<report::CycleSpan> cycle_spans(std::span<const data::Event> events, const TimeBase& recording) {
  std::vector<report::CycleSpan> out;
  for (const auto& cycle : cycles_of(events, recording))
    out.push_back({.side = cycle.side, .start_s = cycle.start_s, .end_s = cycle.end_s});
  return out;
}

std::vector<report::CycleOverlay> cycle_overlays(std::span<const data::Event> events,
                                                 const TimeBase& recording, const data::JointMotion& motion) {
  const auto cycles = cycles_of(events, recording);
  std::vector<report::CycleOverlay> out;
  if (cycles.empty()) return out;
  for (std::int64_t j = 0; j < motion.size(); ++j) {
    const auto series = series_of(motion, j);
    if (!moves(series.values)) continue;
    for (const auto side : data::kBothSides) {
      if (is_of_other_foot(series.id, side)) continue;
      auto curves = analysis::cut_into_cycles(series, cycles, side);
      if (std::ranges::none_of(curves.values, [](double v) { return std::isfinite(v); })) continue;
      auto mean = analysis::mean_of_cycles(curves);
      out.push_back({.curves = std::move(curves),
                     .mean = std::move(mean.mean),
                     .sd = std::move(mean.sd),
                     .cycles = std::move(mean.cycles)});
    }
  }
  return out;
}

}  // namespace kinemark::pipeline::internal
