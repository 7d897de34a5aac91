// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kinemark/pipeline/desk/desk.h"
#include "kinemark/pipeline/desk/plan_text.h"
#include "kinemark/pipeline/session/trial_name.h"

namespace kinemark::pipeline {

/// A rig with two cameras that refuses more than 138 Hz and has a disk that can be full.
struct FakeDesk final : Desk {
  std::vector<stream::DeviceInfo> there = {
      {"sim:rig", "Simulated rig of 1986", ""},
      {"serial:/dev/ttyACM0", "Arduino Uno", "in use by another program"}};
  stream::DeviceCapabilities device;
  LiveView now;
  stream::ScanPlan asked;
  TrialName named;
  std::vector<std::string> calls;
  Status disk = {};
  double light = 1.0;

  FakeDesk() {
    device.name = "rig 1986";
    device.most_leds = 8;
    device.cameras = 2;
    device.bits = 12;
    device.sets_intensity = true;
  }
  std::vector<stream::DeviceInfo> sources() override { return there; }
  Result<stream::DeviceCapabilities> open(const std::string& uri) override {
    calls.push_back("open " + uri);
    if (uri.starts_with("serial:")) return fail(Code::device, fmt::format("{}: another program has it", uri));
    return device;
  }
  Result<stream::GrantedPlan> run(const stream::ScanPlan& plan) override {
    if (plan.rate_hz > 138.0)
      return fail(Code::usage,
                  fmt::format("8 LEDs at {:g} Hz do not fit: the highest rate is 138 Hz", plan.rate_hz));
    asked = plan;
    stream::GrantedPlan granted{plan, {}};
    if (granted.plan.rate_hz == 0.0) granted.plan.rate_hz = 138.0;
    return granted;
  }
  LiveView live() override { return now; }
  Status set_intensity(int, double intensity) override {
    light = intensity;
    return {};
  }
  std::vector<std::string> taken;  ///< names of trials
  std::string free_name(const std::string& trial) const override {
    std::string name = trial;
    while (std::find(taken.begin(), taken.end(), name) != taken.end()) name = next_trial(name);
    return name;
  }
  void restart_guide() override { calls.push_back("restart_guide"); }
  Status record(const TrialName& name) override {
    if (!disk) return disk;
    named = name;
    calls.push_back("record");
    return {};
  }
  Result<std::vector<TrialNote>> stop() override {
    calls.push_back("stop");
    return std::vector<TrialNote>{{"No frame was lost", true},
                                  {"LED 2 is dark in camera B: look at its wire", false}};
  }
  Result<std::string> keep() override {
    calls.push_back("keep");
    return "raw/" + named.trial + ".mcap";
  }
  Status discard() override {
    calls.push_back("discard");
    return {};
  }
  void close() override { calls.push_back("close"); }
};

inline Wanted rig_at(const std::string& leds = "3", const std::string& rate_hz = "") {
  Wanted wanted;
  wanted.source = "sim:rig";
  wanted.leds = leds;
  wanted.rate_hz = rate_hz;
  return wanted;
}
inline Wanted for_seconds(const std::string& duration_s) {
  Wanted wanted = rig_at();
  wanted.duration_s = duration_s;
  return wanted;
}

}  // namespace kinemark::pipeline
