// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/gap_options.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/enum_names.h"

namespace kinemark::trajectory {
namespace {

constexpr EnumNames<GapMethod::automatic> kNames{"none",  "linear",     "cubic", "pchip", "walk",
                                                 "rigid", "regression", "pca",   "auto"};

}  // namespace

std::string_view to_string(GapMethod method) { return kNames[method]; }

Result<GapMethod> parse_gap_method(std::string_view name) { return kNames.parse(name, "gap method"); }

Status GapOptions::check() const {
  if (!(max_gap_s > 0.0))
    return fail(Code::usage, fmt::format("the longest gap is {} s; need more than 0", max_gap_s));
  if (!(max_sd_m > 0.0))
    return fail(Code::usage,
                fmt::format("the largest standard deviation of a fill is {} m; need more than 0", max_sd_m));
  if (!(max_extrapolation_s >= 0.0))
    return fail(Code::usage,
                fmt::format("the longest extrapolation is {} s; need 0 or more", max_extrapolation_s));
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage,
                fmt::format("the noise of a sample is {} m; need a finite number, 0 or more", noise_sd_m));
  if (threads < 0) return fail(Code::usage, fmt::format("{} threads; need 0 (all cores) or more", threads));
  return {};
}

}  // namespace kinemark::trajectory
