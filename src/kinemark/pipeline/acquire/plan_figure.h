// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/acquire/acquire_job.h"
#include "kinemark/stages/report/figures/figure.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// When LEDs are lit and channels converted, one frame and one slot, as a device has granted it: figures 2
/// and 3 of Poizner, Wooten & Salot (1986) of that device.
[[nodiscard]] report::Figure plan_figure(const stream::GrantedPlan& granted);

/// What run_plan() drew.
struct PlanOutcome : JobOutcome {
  stream::GrantedPlan granted;
};

/// Draw what a device grants, which is not started. Fails as the opening of the device, for a plan that it
/// cannot hold (Code::usage, with the highest rate), and where the figure cannot be written.
/// @param file  .svg or .png
[[nodiscard]] Result<PlanOutcome> run_plan(const AcquireJob& job, const std::filesystem::path& file);

/// "6 LEDs at 2 cameras, 138.3 frames per second: slots of 904 us, the LED lit for 704 us of it".
[[nodiscard]] std::string plan_sentence(const stream::GrantedPlan& granted);
/// "written", "leds", "cameras", "rate_hz", "slot_s", "settle_s", "conversion_s", "off_s", "dark_slot",
/// "intensity".
[[nodiscard]] nlohmann::ordered_json plan_json(const PlanOutcome& outcome);

}  // namespace kinemark::pipeline
