// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/menu.h"

#include <algorithm>

#include "kinemark/core/number.h"

namespace kinemark::screens {
namespace {

enum Line : std::uint8_t { kLeds, kRate, kDuration, kSubject, kTrial };  // of the set-up

constexpr double kIntensityStep = 0.1;

Form plan_form(const Wanted& wanted) {
  return Form({{"LEDs", wanted.leds, "How many, or their names with commas: shoulder, elbow, wrist"},
               {"Rate, Hz", wanted.rate_hz, "Frames in a second; empty: as many as the LEDs leave room for"},
               {"Duration, s", wanted.duration_s, "Of a trial; empty: until it is stopped"},
               {"Subject", wanted.subject, "Who is measured; may be empty"},
               {"Trial", wanted.trial, "Name of the next trial"}});
}

std::string trimmed(const std::string& text) { return std::string(trim(text)); }

}  // namespace

Menu::Menu(Desk& desk, Wanted wanted)
    : desk_(desk),
      address_({{"Source", "", "sim:rig, replay:FILE, serial:/dev/ttyACM0, comedi:/dev/comedi0"}}),
      plan_(plan_form(wanted)) {
  look_for_sources();
  if (!wanted.source.empty()) open(wanted.source);
}

void Menu::look_for_sources() {
  sources_ = desk_.sources();
  chosen_source_ = std::min(chosen_source_, sources_.empty() ? 0 : sources_.size() - 1);
}

void Menu::open(const std::string& uri) {
  const auto device = desk_.open(uri);
  if (!device) return tell(device.error());
  uri_ = uri;
  device_ = *device;
  message_.clear();
  screen_ = Screen::plan;
}

void Menu::start() {
  const auto plan = plan_of({uri_, plan_.value(kLeds), plan_.value(kRate), plan_.value(kDuration),
                             plan_.value(kSubject), plan_.value(kTrial)},
                            device_);
  if (!plan) return tell(plan.error());
  auto granted = desk_.run(plan->scan);
  if (!granted) return tell(granted.error());
  granted_ = std::move(*granted);
  if (granted_.plan.intensity.empty()) granted_.plan.intensity.assign(granted_.plan.leds.size(), 1.0);
  duration_s_ = plan->duration_s;
  chosen_led_ = 0;
  message_.clear();
  screen_ = Screen::live;
  tick();
}

void Menu::change_intensity(double by) {
  if (!device_.sets_intensity) {
    message_ = "The light of this device's LEDs cannot be set";
    return;
  }
  double& now = granted_.plan.intensity[chosen_led_];
  const double next = std::clamp(now + by, kIntensityStep, 1.0);
  if (const auto set = desk_.set_intensity(static_cast<int>(chosen_led_), next); !set)
    return tell(set.error());
  now = next;
}

void Menu::record() {
  const TrialName name{trimmed(plan_.value(kSubject)), trimmed(plan_.value(kTrial)), duration_s_};
  if (const auto begun = desk_.record(name); !begun) return tell(begun.error());
  message_.clear();
  screen_ = Screen::recording;
  tick();
}

void Menu::stop() {
  auto check = desk_.stop();
  if (!check) {
    tell(check.error());
    check_.clear();
  } else {
    check_ = std::move(*check);
    message_.clear();
  }
  sure_to_discard_ = false;
  screen_ = Screen::check;
}

void Menu::keep() {
  const auto file = desk_.keep();
  if (!file) return tell(file.error());
  kept_.push_back(*file);
  message_ = "Kept: " + *file;
  plan_.set(kTrial, next_trial(trimmed(plan_.value(kTrial))));
  screen_ = Screen::live;
}

void Menu::discard() {
  if (const auto gone = desk_.discard(); !gone) return tell(gone.error());
  message_ = "Discarded: " + trimmed(plan_.value(kTrial));
  screen_ = Screen::live;
}

void Menu::leave() {
  desk_.close();
  screen_ = Screen::ended;
}

// What is recorded is kept; what was not yet judged too.
void Menu::interrupt() {
  if (screen_ == Screen::recording) stop();
  if (screen_ == Screen::check) keep();
  leave();
}

void Menu::press(const Key& key) {
  if (key.kind == Key::Kind::interrupt) return interrupt();
  switch (screen_) {
    case Screen::source:
      return press_source(key);
    case Screen::plan:
      return press_plan(key);
    case Screen::live:
      return press_live(key);
    case Screen::recording:
      if (key.is(U's') || key.is(U' ') || key.kind == Key::Kind::enter) stop();
      return;
    case Screen::check:
      return press_check(key);
    case Screen::ended:
      return;
  }
}

void Menu::press_source(const Key& key) {
  using Kind = Key::Kind;
  if (typing_address_) {
    if (key.kind == Kind::escape) {
      typing_address_ = false;
    } else if (key.kind == Kind::enter) {
      typing_address_ = false;
      open(trimmed(address_.value(0)));
    } else if (key.kind != Kind::up && key.kind != Kind::down) {
      (void)address_.press(key);
    }
    return;
  }
  if (key.kind == Kind::up && chosen_source_ > 0) --chosen_source_;
  if (key.kind == Kind::down && chosen_source_ + 1 < sources_.size()) ++chosen_source_;
  if (key.kind == Kind::enter && !sources_.empty()) open(sources_[chosen_source_].uri);
  if (key.is(U'o')) typing_address_ = true;
  if (key.is(U'l')) look_for_sources();
  if (key.is(U'q')) leave();
}

void Menu::press_plan(const Key& key) {
  if (plan_.press(key)) return;
  if (key.kind == Key::Kind::enter) start();
  if (key.kind == Key::Kind::escape) {
    desk_.close();
    message_.clear();
    screen_ = Screen::source;
  }
}

void Menu::press_live(const Key& key) {
  using Kind = Key::Kind;
  const std::size_t leds = granted_.plan.leds.size();
  if (key.kind == Kind::up && chosen_led_ > 0) --chosen_led_;
  if (key.kind == Kind::down && chosen_led_ + 1 < leds) ++chosen_led_;
  if (key.is(U'+') || key.kind == Kind::right) change_intensity(kIntensityStep);
  if (key.is(U'-') || key.kind == Kind::left) change_intensity(-kIntensityStep);
  if (key.is(U'r')) record();
  if (key.is(U's') || key.kind == Kind::escape) {
    message_.clear();
    screen_ = Screen::plan;
  }
  if (key.is(U'q')) leave();
}

void Menu::press_check(const Key& key) {
  if (sure_to_discard_) {
    sure_to_discard_ = false;
    if (key.is(U'y')) discard();
    return;
  }
  if (key.is(U'k') || key.kind == Key::Kind::enter) keep();
  if (key.is(U'd')) sure_to_discard_ = true;
}

void Menu::tick() {
  if (screen_ != Screen::live && screen_ != Screen::recording) return;
  live_ = desk_.live();
  if (!live_.trouble.empty()) message_ = live_.trouble;
  if (screen_ == Screen::recording && duration_s_ > 0.0 && live_.recorded_s >= duration_s_) stop();
}

}  // namespace kinemark::screens
