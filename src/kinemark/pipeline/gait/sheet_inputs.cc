// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/sheet_inputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

constexpr double kSameInstant_s = 1e-6;

// What a channel tells of forces at joints, with which quantity.
bool is_joint_kinetics(data::ChannelKind kind, data::Quantity& quantity) {
  if (kind == data::ChannelKind::moment) return quantity = data::Quantity::moment, true;
  if (kind == data::ChannelKind::power) return quantity = data::Quantity::power, true;
  return false;
}

// The plate that saw the cycle's strike; null: none.
const data::Wrench* plate_of(const analysis::GaitCycle& cycle, const data::Wrenches& plates,
                             const analysis::Gait& gait) {
  for (const auto& event : gait.events) {
    if (event.side != cycle.side || event.what != data::FootEvent::strike ||
        event.source != data::EventSource::plate || std::abs(event.time_s - cycle.start_s) > kSameInstant_s)
      continue;
    const auto found = std::ranges::find(plates.items, event.method, &data::Wrench::name);
    if (found != plates.items.end()) return &*found;
  }
  return nullptr;
}

analysis::CycleSeries force_of(const data::Wrench& plate, const TimeBase& time, const Eigen::Vector3d& up) {
  analysis::CycleSeries out{.quantity = data::Quantity::force};
  for (std::int64_t f = 0; f < time.frames; ++f) {
    out.time_s.push_back(time.time_s(f));
    const Eigen::Map<const Eigen::Vector3d> force(&plate.force[at(3 * f)]);
    out.values.push_back(up.dot(force));
  }
  return out;
}

}  // namespace

void add_curves(const std::vector<data::CycleCurves>& curves, std::vector<SheetInput>& out) {
  for (const auto& one : curves)
    if (one.count() > 0) out.push_back({.curves = one});
}

void add_series(const analysis::CycleSeries& series, std::span<const analysis::GaitCycle> cycles,
                const std::string& unit, std::vector<SheetInput>& out) {
  const auto stated = gait_quantity(series.id, series.quantity).side;
  for (const auto side : data::kBothSides) {
    if (stated && *stated != side) continue;
    auto curves = analysis::cut_into_cycles(series, cycles, side);
    if (curves.count() > 0) out.push_back({.curves = std::move(curves), .unit = unit});
  }
}

void add_kinetic_channels(const data::Trial& trial, std::span<const analysis::GaitCycle> cycles,
                          std::vector<SheetInput>& out) {
  const auto& channels = trial.channels;
  const auto count = channels.count();
  for (std::int64_t c = 0; c < count; ++c) {
    auto quantity = data::Quantity::moment;
    if (!is_joint_kinetics(channels.kinds[at(c)], quantity)) continue;
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      analysis::CycleSeries one{.id = fmt::format("{} {}", channels.names[at(c)], "xyz"[axis]),
                                .quantity = quantity};
      if (gait_quantity(one.id, quantity).row < 0) continue;
      bool any = false;
      for (std::int64_t f = 0; f < channels.frames; ++f) {
        one.time_s.push_back(trial.markers.time.t0_s + static_cast<double>(f) / channels.rate_hz);
        one.values.push_back(channels.values[at(3 * (f * count + c) + axis)]);
        any = any || (std::isfinite(one.values.back()) && one.values.back() != 0.0);
      }
      const auto& unit = channels.units[at(c)];
      if (any) add_series(one, cycles, unit.empty() ? "unit of the file" : unit, out);
    }
  }
}

void add_ground_reaction(const data::Wrenches& plates, const Eigen::Vector3d& up, const analysis::Gait& gait,
                         std::vector<SheetInput>& out) {
  for (const auto side : data::kBothSides) {
    data::CycleCurves all{.id = "vertical_ground_reaction",
                          .context = std::string(data::to_string(side)),
                          .quantity = data::Quantity::force};
    bool any = false;
    for (const auto& cycle : gait.cycles) {
      if (cycle.side != side) continue;
      all.cycles.push_back(fmt::format("{} {}", all.context, all.count() + 1));
      const auto* plate = plate_of(cycle, plates, gait);
      if (plate == nullptr) {
        all.values.insert(all.values.end(), at(all.points), kNaN);
        continue;
      }
      any = true;
      const auto cut =
          analysis::cut_into_cycles(force_of(*plate, plates.time, up), {&cycle, 1}, side, all.points);
      for (std::int64_t p = 0; p < all.points; ++p) {
        const double share = static_cast<double>(p) / static_cast<double>(all.points - 1);
        const double t = cycle.start_s + share * (cycle.end_s - cycle.start_s);
        all.values.push_back(t > cycle.off_s ? 0.0 : cut(0, p));
      }
    }
    if (any) out.push_back({.curves = std::move(all)});
  }
}

}  // namespace kinemark::pipeline
