// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject_options.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/enum_names.h"

namespace kinemark::simulation {
namespace {

constexpr EnumNames<MotionKind::mixed> kNames{"walk", "reach", "tai-chi", "mixed"};
constexpr double kMostFrames = 1e7;

Status in_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return {};  // false for NaN
  return fail(Code::usage, fmt::format("{} is {}; expected {} to {}", name, value, low, high));
}

}  // namespace

std::string_view to_string(MotionKind kind) { return kNames[kind]; }

Result<MotionKind> parse_motion_kind(std::string_view name) { return kNames.parse(name, "motion"); }

std::int64_t SubjectOptions::frames() const { return std::llround(duration_s * rate_hz); }

Status SubjectOptions::check() const {
  if (!(duration_s > 0.0) || !(rate_hz > 0.0) || !std::isfinite(duration_s) || !std::isfinite(rate_hz))
    return fail(Code::usage,
                fmt::format("duration_s is {} and rate_hz is {}; both must be positive and finite",
                            duration_s, rate_hz));
  if (!(duration_s * rate_hz >= 0.5 && duration_s * rate_hz <= kMostFrames))
    return fail(Code::usage, fmt::format("duration_s times rate_hz gives {:.6g} frames; expected 1 to {:.0f}",
                                         duration_s * rate_hz, kMostFrames));
  if (threads < 0)
    return fail(Code::usage, fmt::format("threads is {}; expected 0 (all cores) or more", threads));
  for (const auto& status :
       {in_range("full_turns", full_turns, -1e3, 1e3), in_range("noise_sd_m", noise_sd_m, 0.0, 1.0),
        in_range("soft_tissue", soft_tissue, 0.0, 1.0),
        in_range("soft_tissue_common", soft_tissue_common, 0.0, 1.0),
        in_range("dropout_random", dropout_random, 0.0, 0.9),
        in_range("dropout_sight", dropout_sight, 0.0, 0.9)})
    if (!status) return status;
  return {};
}

}  // namespace kinemark::simulation
