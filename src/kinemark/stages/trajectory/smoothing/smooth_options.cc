// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/smooth_options.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/enum_names.h"

namespace kinemark::trajectory {
namespace {

constexpr EnumNames<FilterMethod::classic> kMethods{"none", "kalman", "butterworth",
                                                    "gcv",  "savgol", "classic"};
constexpr EnumNames<CutoffRule::challis> kRules{"winter", "challis"};

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

std::string_view to_string(FilterMethod method) { return kMethods[method]; }

Result<FilterMethod> parse_filter_method(std::string_view name) {
  if (name == "auto") return FilterMethod::kalman;
  return kMethods.parse(name, "filter");
}

std::string_view to_string(CutoffRule rule) { return kRules[rule]; }

Result<CutoffRule> parse_cutoff_rule(std::string_view name) { return kRules.parse(name, "cut-off rule"); }

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
