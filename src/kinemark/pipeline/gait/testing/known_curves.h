// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Curves over the cycle that are known: of each side so many cycles, each higher than the last.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::pipeline::testing {

/// deg: 20 + 30 sin of the phase, cycle c (from 0) higher by `apart_deg` (c - (N - 1) / 2), so that the mean
/// is the curve itself.
inline double known_angle_deg(std::int64_t cycle, std::int64_t cycles, double share, double apart_deg = 2.0) {
  return 20.0 + 30.0 * std::sin(2.0 * std::numbers::pi * share) +
         apart_deg * (static_cast<double>(cycle) - 0.5 * static_cast<double>(cycles - 1));
}

/// Cycles of a curve of one side.
inline SheetInput known_curve(const std::string& id, data::Side side, std::int64_t cycles = 3,
                              double sd_deg = 0.0, double sign = 1.0) {
  data::CycleCurves out{.id = id, .context = std::string(data::to_string(side))};
  for (std::int64_t c = 0; c < cycles; ++c) {
    out.cycles.push_back(out.context + " " + std::to_string(c + 1));
    for (std::int64_t p = 0; p < out.points; ++p) {
      const double share = static_cast<double>(p) / static_cast<double>(out.points - 1);
      out.values.push_back(sign * kRadPerDeg * known_angle_deg(c, cycles, share));
      if (sd_deg > 0.0) out.sd.push_back(kRadPerDeg * sd_deg);
    }
  }
  return {.curves = std::move(out)};
}

/// One that is nowhere measured.
inline SheetInput missing_curve(const std::string& id, data::Side side, std::int64_t cycles = 3) {
  auto out = known_curve(id, side, cycles);
  out.curves.values.assign(out.curves.values.size(), kNaN);
  return out;
}

/// Cycles of 1 s; the foot leaves at 60 % and, of the right, at 64 %.
inline analysis::Gait known_gait(std::int64_t left = 3, std::int64_t right = 3) {
  analysis::Gait out;
  const auto add = [&](data::Side side, std::int64_t cycles, double begin, double off) {
    for (std::int64_t c = 0; c < cycles; ++c) {
      const double start = begin + static_cast<double>(c);
      out.cycles.push_back({.side = side, .start_s = start, .end_s = start + 1.0, .off_s = start + off});
    }
    for (std::int64_t c = 0; c <= cycles && cycles > 0; ++c)
      out.events.push_back({.side = side,
                            .what = data::FootEvent::strike,
                            .time_s = begin + static_cast<double>(c),
                            .sd_s = 0.01,
                            .method = "O'Connor 2007"});
  };
  add(data::Side::left, left, 0.0, 0.60);
  add(data::Side::right, right, 0.5, 0.64);
  data::Measure speed{.id = "gait_speed", .quantity = data::Quantity::speed, .value = 1.2};
  speed.interval = {.kind = data::IntervalKind::two_sided, .low = 1.1, .high = 1.3};
  data::Measure stride{
      .id = "stride_time", .context = "Left", .quantity = data::Quantity::time, .value = 1.0};
  stride.interval = {.kind = data::IntervalKind::two_sided, .low = 0.99, .high = 1.01};
  out.measures = {speed, stride};
  return out;
}

/// A norm of one curve in deg: `mean` with two deviations of 5 deg to each side.
inline NormCurve known_norm(const std::string& name, double mean_deg = 20.0) {
  NormCurve out{.name = name, .unit = "deg", .meaning = "mean \u00b1 2 SD at each point", .source = "A book"};
  for (int p = 0; p <= 100; p += 2) {
    out.at.push_back(p);
    out.low.push_back(mean_deg - 10.0);
    out.high.push_back(mean_deg + 10.0);
    out.mean.push_back(mean_deg);
  }
  return out;
}

/// Names of the twelve angles of the grid as Plug-in Gait's outputs have them, without a side.
inline const std::vector<std::string>& grid_names() {
  static const std::vector<std::string> names{"PelvisAngles x", "PelvisAngles y",      "PelvisAngles z",
                                              "HipAngles x",    "HipAngles y",         "HipAngles z",
                                              "KneeAngles x",   "KneeAngles y",        "KneeAngles z",
                                              "AnkleAngles x",  "FootProgressAngles z"};
  return names;
}

/// Both sides of all of these.
inline std::vector<SheetInput> known_walk(double sd_deg = 0.5) {
  std::vector<SheetInput> out;
  for (const auto& name : grid_names())
    for (const auto side : data::kBothSides)
      out.push_back(known_curve((side == data::Side::left ? "L" : "R") + name, side, 3, sd_deg));
  return out;
}

}  // namespace kinemark::pipeline::testing
