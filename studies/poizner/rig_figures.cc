// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_figures.h"

#include <utility>

#include "kinemark/stages/report/figures/rig_timing.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/poizner_names.h"
#include "studies/poizner/rig_components.h"

namespace kinemark::studies {
namespace {

constexpr double kUs = 1e6;

StudyFigure figure_of(int number, std::string name, report::TimingDiagram diagram) {
  StudyFigure out{.paper = kPoizner, .number = number, .name = std::move(name)};
  for (const auto& trace : diagram.traces)
    out.curves.push_back(curve_of(trace.name, {trace.time, trace.level}));
  out.figure.panels.push_back(report::timing_panel(std::move(diagram)));
  return out;
}

/// Figure 2.
StudyFigure control_signals(const data::Counts& counts, const data::SlotTiming& timing) {
  auto out =
      figure_of(2, "control signals of one frame, LEDs lit in turn", report::frame_timing(counts, timing));
  out.numbers = {{"frames a second", "Hz", 100.0, {}, counts.time.rate_hz}};
  return out;
}

/// Figure 3.
StudyFigure slot_signals(const report::LedSlot& slot, const data::SlotTiming& timing, double time_constant_s,
                         const std::vector<std::string>& cameras) {
  auto out = figure_of(3, "timing of one LED and its conversions",
                       report::slot_timing(slot, timing, time_constant_s, cameras));
  const double first = slot.conversion_s.front(), end = slot.off_s + timing.off_s;
  out.numbers = {{"from LED to first conversion", "µs", 320.0, {}, kUs * (first - slot.on_s)},
                 {"a conversion", "µs", 48.0, {}, kUs * (slot.conversion_s[1] - first)},
                 {"from LED off to the next LED", "µs", 200.0, {}, kUs * (end - slot.off_s)}};
  return out;
}

}  // namespace

Result<std::vector<StudyFigure>> rig_figures(std::uint64_t seed) {
  const auto rig = simulation::draw_rig({.seed = seed});
  if (!rig) return std::unexpected(rig.error());
  simulation::RigRecordingOptions how;
  how.frames = 2;
  how.seed = seed;
  const auto scene = simulation::signing_arm();
  const auto recorded = simulation::record(*rig, scene, how);
  if (!recorded) return std::unexpected(recorded.error());
  const auto& counts = recorded->counts;
  const auto& timing = rig->rig.timing;
  const auto slots = report::schedule_of(counts, timing);
  std::vector<StudyFigure> out;
  out.push_back(rig_components(*rig, scene, counts));
  out.push_back(control_signals(counts, timing));
  out.push_back(slot_signals(slots.front(), timing, rig->rig.electronics.time_constant_s, counts.cameras));
  return out;
}

}  // namespace kinemark::studies
