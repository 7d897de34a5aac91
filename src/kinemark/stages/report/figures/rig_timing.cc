// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/rig_timing.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::report {
namespace {

using Eigen::VectorXd;
using Pulses = std::vector<std::pair<double, double>>;

constexpr double kMs = 1e3, kUs = 1e6;
constexpr double kShown = 0.5;  // of a conversion's time, so that its neighbours are seen apart

TimingTrace trace_of(std::string name, const Pulses& pulses, double scale, double begin, double end) {
  auto train = pulse_train(pulses, begin, end);
  return {.name = std::move(name), .time = scale * train.time, .level = train.level};
}

void add_conversions(double frame_s, const std::vector<double>& begin_s, const data::SlotTiming& timing,
                     Pulses& out) {
  for (const double begins : begin_s)
    out.emplace_back(frame_s + begins, frame_s + begins + kShown * timing.conversion_s);
}

}  // namespace

std::vector<LedSlot> schedule_of(const data::Counts& counts, const data::SlotTiming& timing) {
  check(counts.camera_count() > 0, "a schedule has cameras");
  std::vector<LedSlot> out;
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    LedSlot slot{.led = counts.leds[static_cast<std::size_t>(led)], .conversion_s = {}};
    for (std::int64_t camera = 0; camera < counts.camera_count(); ++camera)
      for (const double at : counts.offset_s(led, camera)) slot.conversion_s.push_back(at);
    slot.on_s = std::ranges::min(slot.conversion_s) - timing.settle_s;
    slot.off_s = std::ranges::max(slot.conversion_s) + timing.conversion_s;
    out.push_back(std::move(slot));
  }
  return out;
}

PulseTrain pulse_train(const std::vector<std::pair<double, double>>& pulses, double begin, double end) {
  std::vector<double> time{begin}, level{0.0};
  const auto step = [&](double at, double from, double to) {
    time.insert(time.end(), {at, at});
    level.insert(level.end(), {from, to});
  };
  for (const auto& [on, off] : pulses) {
    if (on < begin || on >= end) continue;
    step(on, 0.0, 1.0);
    if (off <= end) step(off, 1.0, 0.0);
  }
  time.push_back(end);
  level.push_back(level.back());
  const auto n = static_cast<Eigen::Index>(time.size());
  return {Eigen::Map<const Eigen::VectorXd>(time.data(), n),
          Eigen::Map<const Eigen::VectorXd>(level.data(), n)};
}

TimingDiagram frame_timing(const data::Counts& counts, const data::SlotTiming& timing,
                           const std::vector<double>& intensity) {
  const auto slots = schedule_of(counts, timing);
  const double period = 1.0 / counts.time.rate_hz, end = period + 0.25 * slots.back().off_s;
  TimingDiagram out{.time_label = "time, ms", .end = kMs * end, .traces = {}, .spans = {}};
  Pulses clock, conversions;
  for (const double frame : {0.0, period}) {
    clock.emplace_back(frame, frame + 0.1 * timing.settle_s);
    for (const auto& slot : slots) add_conversions(frame, slot.conversion_s, timing, conversions);
    add_conversions(frame, {counts.dark_time_s.begin(), counts.dark_time_s.end()}, timing, conversions);
  }
  out.traces.push_back(trace_of("frame clock", clock, kMs, 0.0, end));
  for (std::size_t led = 0; led < slots.size(); ++led) {
    Pulses lit;
    for (const double frame : {0.0, period})
      lit.emplace_back(frame + slots[led].on_s, frame + slots[led].off_s);
    auto trace = trace_of(fmt::format("LED {}, {}", led + 1, slots[led].led), lit, kMs, 0.0, end);
    if (led < intensity.size()) trace.level *= intensity[led];
    out.traces.push_back(std::move(trace));
  }
  out.traces.push_back(trace_of("A/D conversions", conversions, kMs, 0.0, end));
  out.traces.back().width = 0.8;
  const double slot_s = timing.slot_s(static_cast<int>(counts.camera_count())), first = slots.front().on_s;
  out.spans = {{kMs * first, kMs * (first + slot_s), fmt::format("slot {:.0f} µs", kUs * slot_s)},
               {0.0, kMs * period, fmt::format("frame {:.4g} ms", kMs * period)}};
  if (!counts.has_dark_slot()) return out;
  const auto [from, to] = std::ranges::minmax(counts.dark_time_s);
  out.spans.insert(out.spans.begin() + 1, {kMs * from, kMs * (to + timing.conversion_s), "dark"});
  return out;
}

TimingDiagram slot_timing(const LedSlot& slot, const data::SlotTiming& timing, double time_constant_s,
                          const std::vector<std::string>& cameras) {
  const double end = slot.off_s + timing.off_s;
  TimingDiagram out{
      .time_label = "time, µs", .begin = kUs * slot.on_s, .end = kUs * end, .traces = {}, .spans = {}};
  out.traces.push_back(trace_of("LED", {{slot.on_s, slot.off_s}}, kUs, slot.on_s, end));
  if (time_constant_s > 0.0) {
    constexpr int kSteps = 200;
    VectorXd time = VectorXd::LinSpaced(kSteps, slot.on_s, end), level(kSteps);
    for (int i = 0; i < kSteps; ++i) {
      const double lit = std::min(time[i], slot.off_s) - slot.on_s,
                   dark = std::max(0.0, time[i] - slot.off_s);
      level[i] = (1.0 - std::exp(-lit / time_constant_s)) * std::exp(-dark / time_constant_s);
    }
    out.traces.push_back({.name = "amplifier", .time = kUs * time, .level = level});
  }
  const std::size_t channels = slot.conversion_s.size() / cameras.size();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto begin = slot.conversion_s.begin() + static_cast<std::ptrdiff_t>(c * channels);
    Pulses pulses;
    add_conversions(0.0, {begin, begin + static_cast<std::ptrdiff_t>(channels)}, timing, pulses);
    out.traces.push_back(trace_of(fmt::format("A/D, camera {}", cameras[c]), pulses, kUs, slot.on_s, end));
  }
  const double first = std::ranges::min(slot.conversion_s);
  out.spans = {
      {kUs * slot.on_s, kUs * first, fmt::format("settle {:.0f} µs", kUs * (first - slot.on_s))},
      {kUs * first, kUs * slot.off_s,
       fmt::format("{} conversions, {:.0f} µs each", slot.conversion_s.size(), kUs * timing.conversion_s)},
      {kUs * slot.off_s, kUs * end, fmt::format("off {:.0f} µs", kUs * timing.off_s)}};
  return out;
}

FigurePanel timing_panel(TimingDiagram diagram) {
  FigurePanel out;
  out.height = height_of(diagram);
  out.picture = [diagram = std::move(diagram)](Canvas& canvas, const CanvasRoom& room) {
    draw(diagram, canvas, room);
  };
  return out;
}

}  // namespace kinemark::report
