// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

namespace kinemark::trajectory {
namespace {

constexpr std::array<std::pair<FilterMethod, std::string_view>, 6> kMethods{
    {{FilterMethod::none, "none"},
     {FilterMethod::kalman, "kalman"},
     {FilterMethod::butterworth, "butterworth"},
     {FilterMethod::gcv, "gcv"},
     {FilterMethod::savgol, "savgol"},
     {FilterMethod::classic, "classic"}}};

Status orders(const SmoothOptions& options) {
  struct Range {
    int low, high;
    const char* what;
  };
  const auto range = [&]() -> Range {
    switch (options.method) {
      case FilterMethod::kalman:
      case FilterMethod::gcv:
        return {2, 5, "2 to 5"};
      case FilterMethod::butterworth:
        return {2, 10, "an even number, 2 to 10"};
      case FilterMethod::savgol:
        return {1, 7, "1 to 7"};
      case FilterMethod::classic:
        return {2, 2, "2 and nothing else"};
      case FilterMethod::none:
        break;
    }
    return {0, 0, "none"};
  }();
  const bool odd = options.method == FilterMethod::butterworth && options.order % 2 != 0;
  if (options.order == 0 || (options.order >= range.low && options.order <= range.high && !odd)) return {};
  return fail(Code::usage, fmt::format("the order of filter {} is {}; expected {}, or 0 for the default",
                                       to_string(options.method), options.order, range.what));
}

}  // namespace

std::string_view to_string(FilterMethod method) {
  for (const auto& [known, name] : kMethods)
    if (known == method) return name;
  return "unknown";
}

Result<FilterMethod> parse_filter_method(std::string_view name) {
  if (name == "auto") return FilterMethod::kalman;
  for (const auto& [method, known] : kMethods)
    if (known == name) return method;
  return fail(Code::usage,
              fmt::format("no filter is called \"{}\"; expected auto, none, kalman, butterworth, gcv, "
                          "savgol or classic",
                          name));
}

std::string_view to_string(CutoffRule rule) { return rule == CutoffRule::winter ? "winter" : "challis"; }

Result<CutoffRule> parse_cutoff_rule(std::string_view name) {
  for (const CutoffRule rule : {CutoffRule::winter, CutoffRule::challis})
    if (to_string(rule) == name) return rule;
  return fail(Code::usage, fmt::format("no cut-off rule is called \"{}\"; expected winter or challis", name));
}

Status SmoothOptions::check(double rate_hz) const {
  if (const auto status = orders(*this); !status) return status;
  if (!(cutoff_hz == 0.0 || (cutoff_hz > 0.0 && cutoff_hz < 0.5 * rate_hz)))  // also NaN
    return fail(Code::usage,
                fmt::format("cutoff_hz is {}; expected more than 0 and less than half of the rate, {} Hz",
                            cutoff_hz, 0.5 * rate_hz));
  if (cutoff_hz > 0.0 && cutoff_hz < 1e-5 * rate_hz)
    return fail(Code::usage,
                fmt::format("cutoff_hz is {}; expected at least a hundred-thousandth of the rate, {} Hz",
                            cutoff_hz, rate_hz));
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage,
                fmt::format("noise_sd_m is {}; expected a positive number, or 0 to find it", noise_sd_m));
  if (!(max_bridge_s >= 0.0) || !(max_bridge_sd_m >= 0.0))
    return fail(Code::usage, fmt::format("max_bridge_s is {} and max_bridge_sd_m {}; expected 0 or more",
                                         max_bridge_s, max_bridge_sd_m));
  if (threads < 0)
    return fail(Code::usage, fmt::format("threads is {}; expected 0 (all cores) or more", threads));
  return {};
}

}  // namespace kinemark::trajectory
