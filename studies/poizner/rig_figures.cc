// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/poizner_names.h"
#include "studies/poizner/rig_components.h"
#include "studies/poizner/rig_schedule.h"
#include "studies/poizner/timing_diagram.h"

namespace kinemark::studies {
namespace {

using Eigen::VectorXd;
using Pulses = std::vector<std::pair<double, double>>;

constexpr double kMs = 1e3, kUs = 1e6;

StudyFigure figure_of(int number, std::string name, TimingDiagram diagram) {
  StudyFigure out{.paper = kPoizner, .number = number, .name = std::move(name)};
  report::FigurePanel panel;
  panel.height = height_of(diagram);
  for (const auto& trace : diagram.traces)
    out.curves.push_back(curve_of(trace.name, {trace.time, trace.level}));
  panel.picture = [diagram = std::move(diagram)](report::Canvas& canvas, const report::CanvasRoom& room) {
    draw(diagram, canvas, room);
  };
  out.figure.panels.push_back(std::move(panel));
  return out;
}

TimingTrace trace_of(std::string name, const Pulses& pulses, double scale, double begin, double end) {
  auto train = pulse_train(pulses, begin, end);
  return {.name = std::move(name), .time = scale * train.time, .level = train.level};
}

/// Figure 2: the frame's clock, every LED's pulse and the conversions, one frame and the beginning of the
/// next.
StudyFigure control_signals(const data::Counts& counts, const std::vector<LedSlot>& slots,
                            const data::SlotTiming& timing) {
  const double period = 1.0 / counts.time.rate_hz, end = period + 0.25 * slots.back().off_s;
  TimingDiagram diagram{.time_label = "time, ms", .end = kMs * end, .traces = {}, .spans = {}};
  Pulses clock, conversions;
  for (int frame = 0; frame < 2; ++frame) {
    const double at = frame * period;
    clock.emplace_back(at, at + 0.1 * timing.settle_s);
    for (const auto& slot : slots)
      for (const double begins : slot.conversion_s)
        conversions.emplace_back(at + begins, at + begins + 0.5 * timing.conversion_s);
  }
  diagram.traces.push_back(trace_of("frame clock", clock, kMs, 0.0, end));
  for (std::size_t led = 0; led < slots.size(); ++led) {
    Pulses lit;
    for (int frame = 0; frame < 2; ++frame)
      lit.emplace_back(frame * period + slots[led].on_s, frame * period + slots[led].off_s);
    diagram.traces.push_back(
        trace_of(fmt::format("LED {}, {}", led + 1, slots[led].led), lit, kMs, 0.0, end));
  }
  diagram.traces.push_back(trace_of("A/D conversions", conversions, kMs, 0.0, end));
  diagram.traces.back().width = 0.8;
  diagram.spans = {{0.0, kMs * slots[1].on_s, fmt::format("slot {:.0f} µs", kUs * slots[1].on_s)},
                   {0.0, kMs * period, fmt::format("frame {:g} ms", kMs * period)}};
  auto out = figure_of(2, "control signals of one frame, LEDs lit in turn", std::move(diagram));
  out.numbers = {{"frames a second", "Hz", 100.0, {}, counts.time.rate_hz}};
  return out;
}

/// Figure 3: one slot: the LED, what a detector sees of it, and its conversions.
StudyFigure slot_timing(const LedSlot& slot, const data::SlotTiming& timing, double time_constant_s,
                        const std::vector<std::string>& cameras) {
  const double end = slot.off_s + timing.off_s;
  constexpr int kSteps = 200;
  VectorXd time = VectorXd::LinSpaced(kSteps, slot.on_s, end), level(kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const double lit = std::min(time[i], slot.off_s) - slot.on_s, dark = std::max(0.0, time[i] - slot.off_s);
    level[i] = (1.0 - std::exp(-lit / time_constant_s)) * std::exp(-dark / time_constant_s);
  }
  TimingDiagram diagram{.time_label = "time, µs", .end = kUs * end, .traces = {}, .spans = {}};
  diagram.traces.push_back(trace_of("LED", {{slot.on_s, slot.off_s}}, kUs, slot.on_s, end));
  diagram.traces.push_back({.name = "amplifier", .time = kUs * time, .level = level});
  const std::size_t channels = slot.conversion_s.size() / cameras.size();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    Pulses pulses;
    for (std::size_t k = 0; k < channels; ++k) {
      const double at = slot.conversion_s[c * channels + k];
      pulses.emplace_back(at, at + 0.5 * timing.conversion_s);
    }
    diagram.traces.push_back(
        trace_of(fmt::format("A/D, camera {}", cameras[c]), pulses, kUs, slot.on_s, end));
  }
  const double first = slot.conversion_s.front();
  diagram.spans = {
      {kUs * slot.on_s, kUs * first, fmt::format("settle {:.0f} µs", kUs * (first - slot.on_s))},
      {kUs * first, kUs * slot.off_s,
       fmt::format("{} conversions, {:.0f} µs each", slot.conversion_s.size(), kUs * timing.conversion_s)},
      {kUs * slot.off_s, kUs * end, fmt::format("off {:.0f} µs", kUs * timing.off_s)}};
  auto out = figure_of(3, "timing of one LED and its conversions", std::move(diagram));
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
  const auto slots = schedule_of(counts, timing);
  std::vector<StudyFigure> out;
  out.push_back(rig_components(*rig, scene, counts));
  out.push_back(control_signals(counts, slots, timing));
  out.push_back(slot_timing(slots.front(), timing, rig->rig.electronics.time_constant_s, counts.cameras));
  return out;
}

}  // namespace kinemark::studies
