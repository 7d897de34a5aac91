// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/menu.h"

#include <algorithm>
#include <utility>

#include "kinemark/core/number.h"

namespace kinemark::screens {
namespace {

using pipeline::DeskStep;
using pipeline::Wanted;

enum Line : std::uint8_t { kLeds, kRate, kDuration, kSubject, kTrial };  // of the set-up

constexpr double kIntensityStep = 0.1;

Form plan_form(const Wanted& wanted) {
  return Form({{"LEDs", wanted.leds, "How many, or their names with commas: shoulder, elbow, wrist"},
               {"Rate, Hz", wanted.rate_hz, "Frames in a second; empty: as many as the LEDs leave room for"},
               {"Duration, s", wanted.duration_s, "Of a trial; empty: until it is stopped"},
               {"Subject", wanted.subject, "Who is measured; may be empty"},
               {"Trial", wanted.trial, "Name of the next trial"}});
}

}  // namespace

Menu::Menu(pipeline::Desk& desk, Wanted wanted)
    : session_(desk, std::move(wanted)),
      address_({{"Source", "", "sim:rig, replay:FILE, serial:/dev/ttyACM0, comedi:/dev/comedi0"}}),
      plan_(plan_form(session_.state().wanted)) {}

void Menu::press(const Key& key) {
  if (key.kind == Key::Kind::none) return;
  if (key.kind == Key::Kind::interrupt) return session_.leave();
  switch (state().step) {
    case DeskStep::source:
      return press_source(key);
    case DeskStep::plan:
      return press_plan(key);
    case DeskStep::live:
      return press_live(key);
    case DeskStep::recording:
      if (key.is(U's') || key.is(U' ') || key.kind == Key::Kind::enter) session_.stop();
      return;
    case DeskStep::check:
      return press_check(key);
    case DeskStep::ended:
      return;
  }
}

void Menu::open(const std::string& uri) {
  session_.open(uri);
  plan_.set(kLeds, state().wanted.leds);
}

void Menu::press_source(const Key& key) {
  using Kind = Key::Kind;
  if (typing_address_) {
    if (key.kind == Kind::enter) open(std::string(trim(address_.value(0))));
    if (key.kind == Kind::enter || key.kind == Kind::escape)
      typing_address_ = false;
    else if (key.kind != Kind::up && key.kind != Kind::down)
      (void)address_.press(key);
    return;
  }
  const auto& sources = state().sources;
  if (key.kind == Kind::up && chosen_source_ > 0) --chosen_source_;
  if (key.kind == Kind::down && chosen_source_ + 1 < sources.size()) ++chosen_source_;
  if (key.kind == Kind::enter && chosen_source_ < sources.size()) open(sources[chosen_source_].uri);
  if (key.is(U'o')) typing_address_ = true;
  if (key.is(U'q')) session_.leave();
  if (!key.is(U'l')) return;
  session_.look_for_sources();
  chosen_source_ = 0;
}

void Menu::press_plan(const Key& key) {
  if (plan_.press(key)) return;
  if (key.kind == Key::Kind::enter) {
    chosen_led_ = 0;
    session_.start({"", plan_.value(kLeds), plan_.value(kRate), plan_.value(kDuration), plan_.value(kSubject),
                    plan_.value(kTrial)});
    plan_.set(kTrial, state().wanted.trial);
  }
  if (key.kind == Key::Kind::escape) session_.leave_source();
}

void Menu::change_intensity(double by) {
  const double now = state().granted.plan.intensity[chosen_led_];
  session_.set_intensity(static_cast<int>(chosen_led_), now + by);
}

void Menu::press_live(const Key& key) {
  using Kind = Key::Kind;
  if (key.kind == Kind::up && chosen_led_ > 0) --chosen_led_;
  if (key.kind == Kind::down && chosen_led_ + 1 < state().granted.plan.leds.size()) ++chosen_led_;
  if (key.is(U'+') || key.kind == Kind::right) change_intensity(kIntensityStep);
  if (key.is(U'-') || key.kind == Kind::left) change_intensity(-kIntensityStep);
  if (key.is(U'a')) session_.restart_guide();
  if (key.is(U'r')) session_.record();
  if (key.is(U's') || key.kind == Kind::escape) session_.set_up();
  if (key.is(U'q')) session_.leave();
}

void Menu::press_check(const Key& key) {
  if (std::exchange(sure_to_discard_, false)) {
    if (key.is(U'y')) session_.discard();
    return;
  }
  if (key.is(U'k') || key.kind == Key::Kind::enter) session_.keep();
  if (key.is(U'd')) sure_to_discard_ = true;
  plan_.set(kTrial, state().wanted.trial);
}

}  // namespace kinemark::screens
