// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/plan_figure.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/stages/report/figures/rig_timing.h"

namespace kinemark::pipeline {
namespace {

double slot_s(const stream::GrantedPlan& granted) {
  return granted.plan.timing.slot_s(static_cast<int>(granted.layout.camera_count()));
}

}  // namespace

report::Figure plan_figure(const stream::GrantedPlan& granted) {
  const auto& timing = granted.plan.timing;
  report::Figure out;
  out.panels.push_back(
      report::timing_panel(report::frame_timing(granted.layout, timing, granted.plan.intensity)));
  const auto slots = report::schedule_of(granted.layout, timing);
  out.panels.push_back(
      report::timing_panel(report::slot_timing(slots.front(), timing, 0.0, granted.layout.cameras)));
  out.caption = plan_sentence(granted);
  out.notes = {fmt::format("Above one frame, below the slot of LED 1, {}.", slots.front().led)};
  return out;
}

std::string plan_sentence(const stream::GrantedPlan& granted) {
  const auto leds = granted.layout.led_count(), cameras = granted.layout.camera_count();
  const double slot = slot_s(granted);
  return fmt::format(
      "{} LED{} at {} camera{}, {:.4g} frames per second: slots of {:.0f} µs, the LED lit for {:.0f} µs of "
      "it",
      leds, leds == 1 ? "" : "s", cameras, cameras == 1 ? "" : "s", granted.plan.rate_hz, 1e6 * slot,
      1e6 * (slot - granted.plan.timing.off_s));
}

Result<PlanOutcome> run_plan(const AcquireJob& job, const std::filesystem::path& file) {
  if (auto s = check_ending(file, {".svg", ".png"}, "a plan"); !s) return std::unexpected(s.error());
  auto granted = granted_plan(job);
  if (!granted) return std::unexpected(granted.error());
  const auto figure = plan_figure(*granted);
  const auto content = ending_of(file) == ".png" ? report::figure_png(figure)
                                                 : Result<std::string>(report::figure_svg(figure));
  if (!content) return std::unexpected(content.error());
  if (auto s = io::write_text(file, *content, job.force); !s) return std::unexpected(s.error());
  PlanOutcome out;
  out.written = {file};
  out.granted = std::move(*granted);
  return out;
}

nlohmann::ordered_json plan_json(const PlanOutcome& outcome) {
  const auto& timing = outcome.granted.plan.timing;
  return {{"written", nlohmann::ordered_json::array({outcome.written.front().string()})},
          {"leds", outcome.granted.layout.leds},
          {"cameras", outcome.granted.layout.cameras},
          {"rate_hz", outcome.granted.plan.rate_hz},
          {"slot_s", slot_s(outcome.granted)},
          {"settle_s", timing.settle_s},
          {"conversion_s", timing.conversion_s},
          {"off_s", timing.off_s},
          {"dark_slot", outcome.granted.layout.has_dark_slot()},
          {"intensity", outcome.granted.plan.intensity}};
}

}  // namespace kinemark::pipeline
