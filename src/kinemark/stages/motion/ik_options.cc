// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/ik_options.h"

#include <fmt/core.h>

#include <cmath>

namespace kinemark::motion {
namespace {

Status need(bool good, const char* what, double has, const char* wanted) {
  if (good) return {};
  return fail(Code::usage, fmt::format("{} is {}; need {}", what, has, wanted));
}

}  // namespace

Status IkOptions::check() const {
  const auto weight_ok = [](double w) { return std::isfinite(w) && w >= 0.0; };
  for (const auto& [marker, weight] : marker_weights)
    if (!weight_ok(weight))
      return fail(Code::bad_input,
                  fmt::format("weight of marker '{}' is {}; need a number of 0 or more", marker, weight));
  for (const auto& task : coordinate_tasks) {
    if (!weight_ok(task.weight))
      return fail(Code::bad_input, fmt::format("weight of coordinate '{}' is {}; need a number of 0 or more",
                                               task.coordinate, task.weight));
    if (!std::isfinite(task.value))
      return fail(Code::bad_input,
                  fmt::format("task value of coordinate '{}' is not a finite number", task.coordinate));
  }
  if (auto s =
          need(weight_ok(default_marker_weight), "default marker weight", default_marker_weight, "0 or more");
      !s)
    return s;
  if (auto s = need(std::isfinite(loss_scale_m) && loss_scale_m > 0, "loss scale", loss_scale_m,
                    "a length above 0 m");
      !s)
    return s;
  if (auto s = need(weight_ok(marker_noise_sd_m), "marker noise", marker_noise_sd_m, "0 m or more"); !s)
    return s;
  if (auto s = need(max_iterations >= 1, "iteration limit", max_iterations, "1 or more"); !s) return s;
  if (auto s = need(starts >= 1, "number of starts", starts, "1 or more"); !s) return s;
  if (auto s = need(threads >= 0, "number of threads", threads, "0 (all cores) or more"); !s) return s;
  if (!(first_time_s <= last_time_s))
    return fail(Code::usage, fmt::format("time range {} to {} s is empty", first_time_s, last_time_s));
  return {};
}

}  // namespace kinemark::motion
