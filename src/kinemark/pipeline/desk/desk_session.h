// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The way of an acquisition, from the source to trials that are kept: what menus and pages show and ask for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/pipeline/desk/desk.h"
#include "kinemark/pipeline/desk/plan_text.h"

namespace kinemark::pipeline {

/// Where a session stands.
enum class DeskStep : std::uint8_t { source, plan, live, recording, check, ended };
[[nodiscard]] std::string_view to_string(DeskStep step);  ///< "source", "plan", ...

/// All that is shown.
struct DeskState {
  DeskStep step = DeskStep::source;
  std::string message;                      ///< of what went wrong, or was done, last; may be empty
  std::vector<stream::DeviceInfo> sources;  ///< that were found
  stream::DeviceCapabilities device;        ///< from the step `plan` on
  Wanted wanted;                            ///< the set-up as typed
  stream::GrantedPlan granted;              ///< from the step `live` on; intensities are always there
  double duration_s = 0.0;                  ///< of a trial; 0: until it is stopped
  LiveView live;                            ///< of the last tick()
  std::vector<TrialNote> check;             ///< of the last trial
  std::vector<std::string> kept;            ///< files
};

/// Source, set-up, live view, recording, check: one after the other and back. What does not belong to the
/// step does nothing; a failure stays at the step and is the message. One thread at a time.
class DeskSession {
 public:
  /// Looks for sources, and opens the one that is wanted.
  DeskSession(Desk& desk, Wanted wanted);
  [[nodiscard]] const DeskState& state() const { return state_; }
  void look_for_sources();
  void open(const std::string& uri);              ///< from `source`
  void leave_source();                            ///< from `plan` back
  void start(Wanted lines);                       ///< from `plan`; the source of the lines is not looked at
  void set_up();                                  ///< from `live` back
  void set_intensity(int led, double intensity);  ///< in `live`; brought into its range, 0.1 to 1
  void restart_guide();                           ///< in `live`
  void name_trial(std::string name);              ///< in `live`: the next one
  void record();                                  ///< from `live`
  void stop();                                    ///< from `recording`
  void keep();                                    ///< from `check`
  void discard();                                 ///< from `check`
  /// End; a trial that is recorded, or not judged yet, is kept.
  void leave();
  /// Take the live numbers, and end a trial whose time is up. Some ten times a second.
  void tick();

 private:
  void fail_with(const Error& error) { state_.message = error.message; }

  Desk& desk_;
  DeskState state_;
  std::string trouble_;  // of the last tick
};

}  // namespace kinemark::pipeline
