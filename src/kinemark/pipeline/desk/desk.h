// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the screens act on: sources, a device, a recording. The real one is in acquire_desk.h; tests have
// their own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/acquire/trial_notes.h"
#include "kinemark/stream/device.h"
#include "kinemark/workflow/rig/counts_monitor.h"

namespace kinemark::pipeline {

/// Live numbers of a device that runs.
struct LiveView {
  std::vector<workflow::LedInCamera> seen;               ///< L x C
  std::vector<std::vector<Eigen::Vector2d>> spots;       ///< L x C, of the last frames
  std::int64_t frames = 0;                               ///< that came since it was started
  std::int64_t acknowledged = 0;                         ///< of the trial that is recorded
  std::int64_t dropped_by_device = 0, dropped_here = 0;  ///< of the trial
  double recorded_s = 0.0;                               ///< of the trial
  bool ended = false;   ///< the trial has ended by itself: the device gives no more, or failed
  std::string guide;    ///< how to align the cameras; empty: nothing known
  std::string trouble;  ///< of the device or the disk; empty: none
};

/// How a trial is called.
struct TrialName {
  std::string subject;      ///< may be empty
  std::string trial;        ///< names its file
  double duration_s = 0.0;  ///< 0: until it is stopped
};

/// See above. All calls from one thread; none waits longer than a device takes to answer.
class Desk {
 public:
  virtual ~Desk() = default;
  /// What is there to be opened; may take a second.
  [[nodiscard]] virtual std::vector<stream::DeviceInfo> sources() = 0;
  /// Open it, and close what was open.
  [[nodiscard]] virtual Result<stream::DeviceCapabilities> open(const std::string& uri) = 0;
  /// Set up and start: the live view runs until close(). A refusal names what is possible.
  [[nodiscard]] virtual Result<stream::GrantedPlan> run(const stream::ScanPlan& plan) = 0;
  /// As it is now.
  [[nodiscard]] virtual LiveView live() = 0;
  /// Light of an LED, of its full light.
  [[nodiscard]] virtual Status set_intensity(int led, double intensity) = 0;
  /// Forget what the alignment guide has seen: a camera was turned.
  virtual void restart_guide() = 0;
  /// That name, or the first one counted on from it of which there is no file.
  [[nodiscard]] virtual std::string free_name(const std::string& trial) const = 0;
  /// Begin a trial.
  [[nodiscard]] virtual Status record(const TrialName& name) = 0;
  /// End the trial; what to know of it before it is kept.
  [[nodiscard]] virtual Result<std::vector<TrialNote>> stop() = 0;
  /// The file of the trial that was stopped.
  [[nodiscard]] virtual Result<std::string> keep() = 0;
  /// Remove the trial that was stopped.
  [[nodiscard]] virtual Status discard() = 0;
  /// LEDs are dark, the device is closed; a trial that is recorded is ended and kept.
  virtual void close() = 0;

 protected:
  Desk() = default;
  Desk(const Desk&) = default;
  Desk& operator=(const Desk&) = default;
};

}  // namespace kinemark::pipeline
