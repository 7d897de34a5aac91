// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/track_options.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

namespace kinemark::motion {
namespace {

constexpr double kLowestCutoff_hz = 0.12;  // below, the filter looks more than 10 s ahead

struct Bounded {
  const char* name;
  double value, low;
  bool low_itself;  ///< the bound is allowed
};

Status check_numbers(const TrackOptions& o) {
  const std::array<Bounded, 16> numbers{{{"omega", o.omega_rad_s, 0.0, false},
                                         {"kp", o.kp, 0.0, true},
                                         {"kd", o.kd, 0.0, true},
                                         {"the step", o.step_s, 0.0, true},
                                         {"damping", o.damping, 0.0, true},
                                         {"truncation", o.truncation, 0.0, false},
                                         {"the cut-off", o.cutoff_hz, 0.0, true},
                                         {"the lookahead", o.lookahead_s, 0.0, true},
                                         {"the fading time", o.fade_s, 0.0, false},
                                         {"the posture's kp", o.posture_kp, 0.0, true},
                                         {"the posture's kd", o.posture_kd, 0.0, true},
                                         {"the largest error", o.max_error_m, 0.0, false},
                                         {"the largest speed", o.max_speed, 0.0, false},
                                         {"the marker noise", o.marker_noise_sd_m, 0.0, true},
                                         {"the level bound", o.level_bound_m, 0.0, true},
                                         {"the accuracy", o.accuracy_rad, 0.0, true}}};
  for (const auto& n : numbers)
    if (!std::isfinite(n.value) || n.value < n.low || (!n.low_itself && n.value == n.low))
      return fail(Code::usage, fmt::format("{} is {}; it must be {} {}", n.name, n.value,
                                           n.low_itself ? "at least" : "more than", n.low));
  if (o.cutoff_hz > 0.0 && o.cutoff_hz < kLowestCutoff_hz)
    return fail(Code::usage, fmt::format("the cut-off is {} Hz; it must be 0 (none) or at least {} Hz",
                                         o.cutoff_hz, kLowestCutoff_hz));
  if ((o.kp > 0.0) != (o.kd > 0.0))
    return fail(Code::usage, fmt::format("kp is {} and kd is {}; give both, or omega alone", o.kp, o.kd));
  if (o.accuracy_rad > 0.0 && (o.kp > 0.0 || o.derivatives != nullptr))
    return fail(Code::usage,
                "an accuracy chooses gains and cut-off; gains or derivatives of samples are given");
  if (o.truncation >= 1.0)
    return fail(Code::usage, fmt::format("truncation is {}; it must be below 1", o.truncation));
  if (o.lookahead_s > 10.0 || o.fade_s > 10.0)
    return fail(Code::usage, "lookahead and fading time must not exceed 10 s");
  return {};
}

}  // namespace

Status TrackOptions::check() const {
  if (auto status = check_numbers(*this); !status) return status;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].markers.empty() && levels[i].tasks.empty() && levels[i].named.empty())
      return fail(Code::usage,
                  fmt::format("level {} has no tasks; name at least one marker or goal in it", i + 1));
    if (!std::isfinite(levels[i].weight) || levels[i].weight < 0.0 ||
        (levels[i].weight > 0.0) != (levels.front().weight > 0.0))
      return fail(Code::usage, fmt::format("level {} weighs {}; give each level a weight above 0, or none",
                                           i + 1, levels[i].weight));
    for (const auto& task : levels[i].tasks)
      if (task == nullptr) return fail(Code::usage, fmt::format("level {} holds a task that is null", i + 1));
  }
  if (propose_levels && !levels.empty())
    return fail(Code::usage, "levels are given, and levels are to be proposed; need one of both");
  if (starts < 1) return fail(Code::usage, fmt::format("starts is {}; need at least 1", starts));
  if (threads < 0) return fail(Code::usage, fmt::format("threads is {}; must not be negative", threads));
  return {};
}

}  // namespace kinemark::motion
