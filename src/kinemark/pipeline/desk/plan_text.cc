// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/plan_text.h"

#include <fmt/core.h>

#include "kinemark/core/number.h"
#include "kinemark/pipeline/acquire/led_names.h"

namespace kinemark::pipeline {
namespace {

std::string trimmed(const std::string& text) { return std::string(trim(text)); }

Result<double> parse_positive(const std::string& text, const char* what) {
  if (text.empty()) return 0.0;
  const auto number = parse_number(text);
  if (!number || !(*number > 0.0))
    return fail(Code::usage, fmt::format("{}: '{}' is no number above 0", what, text));
  return *number;
}

}  // namespace

Result<Plan> plan_of(const Wanted& wanted, const stream::DeviceCapabilities& device) {
  auto leds = parse_leds(wanted.leds, device);
  if (!leds) return std::unexpected(leds.error());
  const auto rate = parse_positive(wanted.rate_hz, "Rate");
  if (!rate) return std::unexpected(rate.error());
  const auto duration = parse_positive(wanted.duration_s, "Duration");
  if (!duration) return std::unexpected(duration.error());
  if (trimmed(wanted.trial).empty()) return fail(Code::usage, "Trial: a name is missing");
  Plan plan;
  plan.duration_s = *duration;
  plan.scan.leds = std::move(*leds);
  plan.scan.rate_hz = *rate;
  plan.scan.timing = stream::usual_timing(device);
  plan.scan.cameras = stream::own_names(device.camera_names, device.cameras, true);
  return plan;
}

}  // namespace kinemark::pipeline
