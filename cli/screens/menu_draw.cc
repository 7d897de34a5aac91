// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the menus look like.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/screens/menu.h"

namespace kinemark::screens {
namespace {

constexpr int kName = 10, kBar = 5,
              kCamera = 17;  // columns of a name, of a bar, of what a camera says of an LED
constexpr int kFrame = 6;    // rows of heading, guide, message and keys

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.0f}%", 100.0 * share); }

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
  switch (screen_) {
    case Screen::source:
      return "Source";
    case Screen::plan:
      return "Set-up of " + device_.name;
    case Screen::live:
      return fmt::format("Live: {} LEDs, {} cameras, {:.4g} Hz; {} frames", granted_.plan.leds.size(),
                         granted_.plan.cameras.size(), granted_.plan.rate_hz, live_.frames);
    case Screen::recording:
      return fmt::format("RECORDING {}: {:.1f} s{}; {} kept, lost by the device {}, here {}", plan_.value(4),
                         live_.recorded_s, duration_s_ > 0.0 ? fmt::format(" of {:g}", duration_s_) : "",
                         live_.acknowledged, live_.dropped_by_device, live_.dropped_here);
    case Screen::check:
      return "Check of " + plan_.value(4);
    case Screen::ended:
      return "";
  }
  return "";
}

std::string Menu::keys() const {
  switch (screen_) {
    case Screen::source:
      return typing_address_ ? "Enter open   Esc back"
                             : "↑↓ choose   Enter open   o type an address   l look again   q quit";
    case Screen::plan:
      return "↑↓ choose   Enter start   Esc another source";
    case Screen::live:
      return device_.sets_intensity ? "r record   ↑↓ LED   +- its light   s set-up   q quit"
                                    : "r record   ↑↓ LED   s set-up   q quit";
    case Screen::recording:
      return "s stop";
    case Screen::check:
      return sure_to_discard_ ? "y discard it   any other key: back" : "k keep   d discard";
    case Screen::ended:
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
  if (screen_ == Screen::source) draw_source(canvas);
  if (screen_ == Screen::plan) draw_plan(canvas);
  if (screen_ == Screen::live || screen_ == Screen::recording) draw_live(canvas);
  if (screen_ == Screen::check) draw_check(canvas);
  // A message of more than a line goes on in the one above the keys.
  const auto width = static_cast<std::size_t>(columns - 2);
  std::size_t cut = message_.size();
  if (cut > width) cut = std::min(message_.rfind(' ', width), width);
  canvas.text(rows - 3, 1, message_.substr(0, cut), Ink::bold);
  if (cut < message_.size()) canvas.text(rows - 2, 1, message_.substr(cut + 1), Ink::bold);
  canvas.text(rows - 1, 1, keys(), Ink::chosen);
  return canvas;
}

void Menu::draw_source(Canvas& canvas) const {
  if (sources_.empty())
    canvas.text(2, 2, "No device was found: plug one in and press l, or type an address (o).");
  const int most = canvas.rows() - 12;
  for (std::size_t i = 0; i < sources_.size() && static_cast<int>(i) < most; ++i) {
    const int row = 2 + static_cast<int>(i);
    const bool chosen = i == chosen_source_ && !typing_address_;
    canvas.text(row, 2, chosen ? ">" : " ", Ink::bold);
    canvas.text(row, 4, sources_[i].uri, chosen ? Ink::bold : Ink::plain, 26);
    canvas.text(row, 32, sources_[i].state.empty() ? sources_[i].name : sources_[i].state, Ink::plain);
  }
  if (typing_address_) address_.draw(canvas, canvas.rows() - 8, 2);
}

void Menu::draw_plan(Canvas& canvas) const {
  plan_.draw(canvas, 2, 2);
  const int row = 3 + plan_.rows();
  canvas.text(row, 4,
              device_.most_leds > 0 ? fmt::format("{}: up to {} LEDs, {} cameras, {} bits", device_.name,
                                                  device_.most_leds, device_.cameras, device_.bits)
                                    : fmt::format("{}: lights no LEDs, {} cameras, {} bits", device_.name,
                                                  device_.cameras, device_.bits),
              Ink::dim);
  const auto leds = parse_leds(plan_.value(0));
  if (!leds) return;
  const int count = static_cast<int>(leds->size());
  canvas.text(row + 1, 4,
              fmt::format("{} LEDs: {:.1f} Hz at most, a slot of {:.0f} us for each", count,
                          device_.fastest.highest_rate_hz(count, device_.cameras),
                          1e6 * device_.fastest.slot_s(device_.cameras)),
              Ink::dim);
}

// Detectors side by side, as large as they can be: the table of LEDs stands beside them or below.
void Menu::draw_live(Canvas& canvas) const {
  const int cameras = std::max(static_cast<int>(granted_.plan.cameras.size()), 1);
  const int table = kName + 6 + kCamera * cameras;
  const int room = canvas.rows() - kFrame;
  const int beside = std::min((canvas.columns() - table - 3) / (2 * cameras), room);
  const int below = std::min((canvas.columns() - 2) / (2 * cameras),
                             room - 1 - static_cast<int>(granted_.plan.leds.size()));
  const int rows = std::max({beside, below, 4});
  draw_detectors(canvas, rows, 2 * rows);
  if (beside >= below)
    draw_leds(canvas, 2, cameras * 2 * rows + 2);
  else
    draw_leds(canvas, 2 + rows, 1);
  if (!live_.guide.empty()) canvas.text(canvas.rows() - 4, 1, "Alignment: " + live_.guide);
}

void Menu::draw_detectors(Canvas& canvas, int rows, int width) const {
  const auto cameras = granted_.plan.cameras.size(), leds = granted_.plan.leds.size();
  for (std::size_t c = 0; c < cameras; ++c) {
    const int column = 1 + static_cast<int>(c) * width;
    canvas.box(2, column, rows, width, granted_.plan.cameras[c]);
    for (std::size_t l = 0; l < leds && l * cameras + c < live_.spots.size(); ++l)
      canvas.dots(3, column + 1, rows - 2, width - 2, live_.spots[l * cameras + c],
                  l == chosen_led_ ? Ink::bold : Ink::plain);
  }
}

void Menu::draw_leds(Canvas& canvas, int row, int column) const {
  const auto cameras = granted_.plan.cameras.size(), leds = granted_.plan.leds.size();
  canvas.text(row, column + kName, "light", Ink::dim);
  for (std::size_t c = 0; c < cameras; ++c)
    canvas.text(row, column + kName + 6 + kCamera * static_cast<int>(c),
                fmt::format("{:<5.5} noise hid", granted_.plan.cameras[c]), Ink::dim);
  for (std::size_t l = 0; l < leds; ++l) {
    const int at = row + 1 + static_cast<int>(l);
    if (at >= canvas.rows() - 4) break;
    const bool chosen = l == chosen_led_;
    canvas.text(at, column, (chosen ? ">" : " ") + granted_.plan.leds[l], chosen ? Ink::bold : Ink::plain,
                kName - 1);
    canvas.text(at, column + kName, percent(granted_.plan.intensity[l]));
    for (std::size_t c = 0; c < cameras && l * cameras + c < live_.seen.size(); ++c)
      draw_led(canvas, at, column + kName + 6 + kCamera * static_cast<int>(c), live_.seen[l * cameras + c]);
  }
}

void Menu::draw_check(Canvas& canvas) const {
  const int most = canvas.rows() - 7;
  for (std::size_t i = 0; i < check_.size() && static_cast<int>(i) < most; ++i)
    canvas.text(2 + static_cast<int>(i), 2, (check_[i].good ? "  " : "! ") + check_[i].text,
                check_[i].good ? Ink::plain : Ink::bold);
  if (sure_to_discard_)
    canvas.text(canvas.rows() - 5, 2, "Discard " + plan_.value(4) + "? Its frames are gone then.", Ink::bold);
}

}  // namespace kinemark::screens
