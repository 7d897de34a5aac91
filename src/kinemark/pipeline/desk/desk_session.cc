// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/desk_session.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/pipeline/session/trial_name.h"

namespace kinemark::pipeline {
namespace {

constexpr double kLeastIntensity = 0.1;  // below, an LED is hardly told from a dark one

}  // namespace

std::string_view to_string(DeskStep step) {
  static constexpr std::array<std::string_view, 6> kNames = {"source",    "plan",  "live",
                                                             "recording", "check", "ended"};
  return kNames[static_cast<std::size_t>(step)];
}

DeskSession::DeskSession(Desk& desk, Wanted wanted) : desk_(desk) {
  const std::string source = std::exchange(wanted.source, {});
  state_.wanted = std::move(wanted);
  look_for_sources();
  if (!source.empty()) open(source);
}

void DeskSession::look_for_sources() {
  if (state_.step == DeskStep::source) state_.sources = desk_.sources();
}

void DeskSession::open(const std::string& uri) {
  if (state_.step != DeskStep::source) return;
  const auto device = desk_.open(uri);
  if (!device) return fail_with(device.error());
  state_.wanted.source = uri;
  state_.device = *device;
  if (state_.wanted.leds.empty()) state_.wanted.leds = std::to_string(std::max(device->most_leds, 1));
  state_.message.clear();
  state_.step = DeskStep::plan;
}

void DeskSession::leave_source() {
  if (state_.step != DeskStep::plan) return;
  desk_.close();
  state_.message.clear();
  state_.step = DeskStep::source;
}

void DeskSession::start(Wanted lines) {
  if (state_.step != DeskStep::plan) return;
  lines.source = state_.wanted.source;
  state_.wanted = std::move(lines);
  const auto plan = plan_of(state_.wanted, state_.device);
  if (!plan) return fail_with(plan.error());
  auto granted = desk_.run(plan->scan);
  if (!granted) return fail_with(granted.error());
  state_.granted = std::move(*granted);
  auto& intensity = state_.granted.plan.intensity;
  if (intensity.empty()) intensity.assign(state_.granted.plan.leds.size(), 1.0);
  state_.duration_s = plan->duration_s;
  state_.wanted.trial = desk_.free_name(std::string(trim(state_.wanted.trial)));
  state_.message.clear();
  trouble_.clear();
  state_.step = DeskStep::live;
  tick();
}

void DeskSession::set_up() {
  if (state_.step != DeskStep::live) return;
  state_.message.clear();
  state_.step = DeskStep::plan;
}

void DeskSession::set_intensity(int led, double intensity) {
  auto& now = state_.granted.plan.intensity;
  if (state_.step != DeskStep::live || led < 0 || led >= static_cast<int>(now.size())) return;
  if (!state_.device.sets_intensity) {
    state_.message = "The light of this device's LEDs cannot be set";
    return;
  }
  const double next = std::clamp(intensity, kLeastIntensity, 1.0);
  if (const auto set = desk_.set_intensity(led, next); !set) return fail_with(set.error());
  now[static_cast<std::size_t>(led)] = next;
}

void DeskSession::restart_guide() {
  if (state_.step == DeskStep::live) desk_.restart_guide();
}

void DeskSession::name_trial(std::string name) {
  if (state_.step == DeskStep::live) state_.wanted.trial = std::move(name);
}

void DeskSession::record() {
  if (state_.step != DeskStep::live) return;
  const TrialName name{std::string(trim(state_.wanted.subject)), std::string(trim(state_.wanted.trial)),
                       state_.duration_s};
  if (const auto begun = desk_.record(name); !begun) return fail_with(begun.error());
  state_.message.clear();
  trouble_.clear();  // what is still so is said again
  state_.step = DeskStep::recording;
  tick();
}

void DeskSession::stop() {
  if (state_.step != DeskStep::recording) return;
  state_.message.clear();
  auto check = desk_.stop();
  state_.check.clear();
  if (check)
    state_.check = std::move(*check);
  else
    fail_with(check.error());
  state_.step = DeskStep::check;
}

void DeskSession::keep() {
  if (state_.step != DeskStep::check) return;
  const auto file = desk_.keep();
  if (!file) return fail_with(file.error());
  state_.kept.push_back(*file);
  state_.message = "Kept: " + *file;
  state_.wanted.trial = desk_.free_name(next_trial(state_.wanted.trial));
  state_.step = DeskStep::live;
}

void DeskSession::discard() {
  if (state_.step != DeskStep::check) return;
  if (const auto gone = desk_.discard(); !gone) return fail_with(gone.error());
  state_.message = "Discarded: " + state_.wanted.trial;
  state_.step = DeskStep::live;
}

void DeskSession::leave() {
  stop();
  keep();
  desk_.close();
  state_.step = DeskStep::ended;
}

void DeskSession::tick() {
  if (state_.step != DeskStep::live && state_.step != DeskStep::recording) return;
  state_.live = desk_.live();
  if (state_.live.trouble != trouble_) {
    if (state_.message == trouble_) state_.message.clear();  // it is over
    trouble_ = state_.live.trouble;
    if (!trouble_.empty()) state_.message = trouble_;
  }
  const bool over =
      state_.live.ended || (state_.duration_s > 0.0 && state_.live.recorded_s >= state_.duration_s);
  if (state_.step == DeskStep::recording && over) stop();
}

}  // namespace kinemark::pipeline
