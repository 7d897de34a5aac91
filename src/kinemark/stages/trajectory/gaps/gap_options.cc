// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/gap_options.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinemark::trajectory {
namespace {

constexpr std::array<std::string_view, 9> kNames = {"none",  "linear",     "cubic", "pchip", "walk",
                                                    "rigid", "regression", "pca",   "auto"};

}  // namespace

std::string_view to_string(GapMethod method) { return kNames[static_cast<std::size_t>(method)]; }

Result<GapMethod> parse_gap_method(std::string_view name) {
  const auto at = std::ranges::find(kNames, name);
  if (at == kNames.end())
    return fail(Code::usage,
                fmt::format("there is no gap method '{}'; there are {}", name, fmt::join(kNames, ", ")));
  return static_cast<GapMethod>(at - kNames.begin());
}

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
