// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the menus look like.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/screens/menu.h"
#include "kinemark/pipeline/acquire/led_names.h"

namespace kinemark::screens {
namespace {

using pipeline::DeskStep;

constexpr int kName = 10, kBar = 5,
              kCamera = 17;  // columns of a name, of a bar, of what a camera says of an LED
constexpr int kFrame = 6;    // rows of heading, guide, message and keys

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.0f}%", 100.0 * share); }

// A sentence in lines of at most that many bytes, broken at blanks.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.size();
    if (end - begin > width) {
      end = text.rfind(' ', begin + width);
      if (end == std::string::npos || end <= begin) end = begin + width;
    }
    lines.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(' ', end);
  }
  return lines;
}

// Level, noise and what is wrong, of one LED in one camera.
void draw_led(Canvas& canvas, int row, int column, const workflow::LedInCamera& led) {
  canvas.bar(row, column, kBar, led.highest_share);
  if (!std::isnan(led.noise_counts))
    canvas.text(row, column + kBar + 1, fmt::format("{:4.1f}", led.noise_counts));
  const char* word = led.occluded_share >= 1.0   ? "dark"
                     : led.saturated_share > 0.0 ? "clips"
                     : led.occluded_share > 0.0  ? nullptr
                                                 : "";
  const int at = column + kBar + 6;
  if (word != nullptr)
    canvas.text(row, at, word, Ink::bold);
  else
    canvas.text(row, at, percent(led.occluded_share), Ink::bold);
}

}  // namespace

std::string Menu::heading() const {
  switch (state().step) {
    case DeskStep::source:
      return "Source";
    case DeskStep::plan:
      return "Set-up of " + state().device.name;
    case DeskStep::live:
      return fmt::format("Live: {} LEDs, {} cameras, {:.4g} Hz; {} frames", state().granted.plan.leds.size(),
                         state().granted.plan.cameras.size(), state().granted.plan.rate_hz,
                         state().live.frames);
    case DeskStep::recording:
      return fmt::format("RECORDING {}: {:.1f} s{}; {} kept, lost by the device {}, here {}",
                         state().wanted.trial, state().live.recorded_s,
                         state().duration_s > 0.0 ? fmt::format(" of {:g}", state().duration_s) : "",
                         state().live.acknowledged, state().live.dropped_by_device,
                         state().live.dropped_here);
    case DeskStep::check:
      return "Check of " + state().wanted.trial;
    case DeskStep::ended:
      return "";
  }
  return "";
}

std::string Menu::keys() const {
  switch (state().step) {
    case DeskStep::source:
      return typing_address_ ? "Enter open   Esc back"
                             : "↑↓ choose   Enter open   o type an address   l look again   q quit";
    case DeskStep::plan:
      return "↑↓ choose   Enter start   Esc another source";
    case DeskStep::live:
      return std::string("r record   ↑↓ LED") + (state().device.sets_intensity ? "   +- its light" : "") +
             (state().live.guide.empty() ? "" : "   a align anew") + "   s set-up   q quit";
    case DeskStep::recording:
      return "s stop";
    case DeskStep::check:
      return sure_to_discard_ ? "y discard it   any other key: back" : "k keep   d discard";
    case DeskStep::ended:
      return "";
  }
  return "";
}

Canvas Menu::draw(int rows, int columns) const {
  Canvas canvas(rows, columns);
  if (rows < kLeastRows || columns < kLeastColumns) {
    canvas.text(0, 0, fmt::format("This terminal is {} x {}:", columns, rows));
    canvas.text(1, 0, fmt::format("make it {} x {} or larger.", kLeastColumns, kLeastRows));
    return canvas;
  }
  canvas.text(0, 1, "kinemark acquire", Ink::dim);
  canvas.text(0, 19, heading(), Ink::bold);
  if (state().step == DeskStep::source) draw_source(canvas);
  if (state().step == DeskStep::plan) draw_plan(canvas);
  if (state().step == DeskStep::live || state().step == DeskStep::recording) draw_live(canvas);
  if (state().step == DeskStep::check) draw_check(canvas);
  const std::string message =
      sure_to_discard_ ? "Discard " + state().wanted.trial + "? Its frames are gone then." : state().message;
  int row = rows - 3;
  for (const std::string& part : wrapped(message, static_cast<std::size_t>(columns - 2)))
    if (row < rows - 1) canvas.text(row++, 1, part, Ink::bold);
  canvas.text(rows - 1, 1, keys(), Ink::chosen);
  return canvas;
}

void Menu::draw_source(Canvas& canvas) const {
  if (state().sources.empty())
    canvas.text(2, 2, "No device was found: plug one in and press l, or type an address (o).");
  const int most = canvas.rows() - 12;
  for (std::size_t i = 0; i < state().sources.size() && static_cast<int>(i) < most; ++i) {
    const int row = 2 + static_cast<int>(i);
    const bool chosen = i == chosen_source_ && !typing_address_;
    canvas.text(row, 2, chosen ? ">" : " ", Ink::bold);
    canvas.text(row, 4, state().sources[i].uri, chosen ? Ink::bold : Ink::plain, 26);
    canvas.text(row, 32,
                state().sources[i].state.empty() ? state().sources[i].name : state().sources[i].state,
                Ink::plain);
  }
  if (typing_address_) address_.draw(canvas, canvas.rows() - 8, 2);
}

void Menu::draw_plan(Canvas& canvas) const {
  plan_.draw(canvas, 2, 2);
  const int row = 3 + plan_.rows();
  canvas.text(row, 4,
              state().device.most_leds > 0
                  ? fmt::format("{}: up to {} LEDs, {} cameras, {} bits", state().device.name,
                                state().device.most_leds, state().device.cameras, state().device.bits)
                  : fmt::format("{}: lights no LEDs, {} cameras, {} bits", state().device.name,
                                state().device.cameras, state().device.bits),
              Ink::dim);
  const auto leds = pipeline::parse_leds(plan_.value(0), state().device);
  if (!leds) return;
  const int count = static_cast<int>(leds->size());
  const data::SlotTiming timing = stream::usual_timing(state().device);
  canvas.text(row + 1, 4,
              fmt::format("{} LEDs: {:.1f} Hz at most, a slot of {:.0f} us for each", count,
                          timing.highest_rate_hz(count, state().device.cameras),
                          1e6 * timing.slot_s(state().device.cameras)),
              Ink::dim);
}

// Detectors side by side, as large as they can be: the table of LEDs stands beside them or below.
void Menu::draw_live(Canvas& canvas) const {
  const int cameras = std::max(static_cast<int>(state().granted.plan.cameras.size()), 1);
  const int table = kName + 6 + kCamera * cameras;
  const int room = canvas.rows() - kFrame;
  const int beside = std::min((canvas.columns() - table - 3) / (2 * cameras), room);
  const int below = std::min((canvas.columns() - 2) / (2 * cameras),
                             room - 1 - static_cast<int>(state().granted.plan.leds.size()));
  const int rows = std::max({beside, below, 4});
  draw_detectors(canvas, rows, 2 * rows);
  if (beside >= below)
    draw_leds(canvas, 2, cameras * 2 * rows + 2);
  else
    draw_leds(canvas, 2 + rows, 1);
  if (!state().live.guide.empty()) canvas.text(canvas.rows() - 4, 1, "Alignment: " + state().live.guide);
}

void Menu::draw_detectors(Canvas& canvas, int rows, int width) const {
  const auto cameras = state().granted.plan.cameras.size(), leds = state().granted.plan.leds.size();
  for (std::size_t c = 0; c < cameras; ++c) {
    const int column = 1 + static_cast<int>(c) * width;
    canvas.box(2, column, rows, width, state().granted.plan.cameras[c]);
    for (std::size_t l = 0; l < leds && l * cameras + c < state().live.spots.size(); ++l)
      canvas.dots(3, column + 1, rows - 2, width - 2, state().live.spots[l * cameras + c],
                  l == chosen_led_ ? Ink::bold : Ink::plain);
  }
}

void Menu::draw_leds(Canvas& canvas, int row, int column) const {
  const auto cameras = state().granted.plan.cameras.size(), leds = state().granted.plan.leds.size();
  canvas.text(row, column + kName, "light", Ink::dim);
  for (std::size_t c = 0; c < cameras; ++c)
    canvas.text(row, column + kName + 6 + kCamera * static_cast<int>(c),
                fmt::format("{:<5.5} noise hid", state().granted.plan.cameras[c]), Ink::dim);
  for (std::size_t l = 0; l < leds; ++l) {
    const int at = row + 1 + static_cast<int>(l);
    if (at >= canvas.rows() - 4) break;
    const bool chosen = l == chosen_led_;
    canvas.text(at, column, (chosen ? ">" : " ") + state().granted.plan.leds[l],
                chosen ? Ink::bold : Ink::plain, kName - 1);
    canvas.text(at, column + kName, percent(state().granted.plan.intensity[l]));
    for (std::size_t c = 0; c < cameras && l * cameras + c < state().live.seen.size(); ++c)
      draw_led(canvas, at, column + kName + 6 + kCamera * static_cast<int>(c),
               state().live.seen[l * cameras + c]);
  }
}

void Menu::draw_check(Canvas& canvas) const {
  int row = 2;
  for (const auto& line : state().check) {
    bool first = true;
    for (const std::string& part : wrapped(line.text, static_cast<std::size_t>(canvas.columns() - 6))) {
      if (row >= canvas.rows() - 5) return;
      if (first && !line.good) canvas.text(row, 2, "!", Ink::bold);
      canvas.text(row++, first ? 4 : 6, part, line.good ? Ink::plain : Ink::bold);
      first = false;
    }
  }
}

}  // namespace kinemark::screens
