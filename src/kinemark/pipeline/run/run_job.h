// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The way of a whole study: every step of every recording, begun again where it was stopped.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/many.h"
#include "kinemark/pipeline/run/run_steps.h"

namespace kinemark::pipeline {

/// How a command ended.
struct CommandEnd {
  int exit_status = 0;            ///< as documented
  std::vector<std::string> said;  ///< its lines on stderr
};

/// What `kinemark run` is asked to do.
struct RunJob : JobSettings {
  std::filesystem::path file;     ///< run file
  std::vector<std::string> only;  ///< subjects to do; empty: all
  int jobs = 1;                   ///< steps at a time; 0: one for each core
  bool keep_going = false;        ///< other subjects and recordings are done when a step has failed
  bool plan_only = false;         ///< nothing runs, nothing is written
  /// Checks the words of a command without running it.
  std::function<Status(const std::vector<std::string>& words)> check;
  /// Runs a command in a folder; the words --reads=FILE among its name files that it must not replace;
  /// Code::io where it cannot be started.
  std::function<Result<CommandEnd>(const std::vector<std::string>& words,
                                   const std::filesystem::path& folder)>
      start;
};

/// One step.
struct StepOutcome {
  RunStep step;                                 ///< what it was
  TrialStatus status = TrialStatus::not_begun;  ///< how it fared
  std::string said;                             ///< the failure, the gate that was missed, or the first note
  double seconds = 0.0;                         ///< wall time
  int exit_status = 0;                          ///< of this one alone
};

/// How all of them fared, in the order of the file.
struct RunOutcome {
  std::vector<StepOutcome> steps;  ///< one a command

  /// The worst: a failure's, else 1 where a gate was missed, else 0.
  [[nodiscard]] int exit_status() const;
};

/// Plans the steps of a run file, checks all commands, then runs those that are due, each as soon as those
/// that it needs are done. A step is not done again while its command, the program's version and the content
/// of its inputs are as they were and its results are there; a file that no run made, or that was changed
/// since, is not replaced without `force`. What a killed run left is done again. Progress counts steps.
///
/// Fails before anything is written: as read_run_file() and plan_steps(), Code::bad_input for a command that
/// is none (naming the line), Code::usage for a subject that is not in the file and for a file that steps
/// write where it is one that they read and none of them makes; Code::io where the output folder cannot be
/// made, or another run is at work in it.
[[nodiscard]] Result<RunOutcome> run_study(const RunJob& job);

/// How the steps of a run fared: a heading, a line for each (subject, recording, step, status, seconds, what
/// was said), and how many fared how.
[[nodiscard]] std::string run_table(const RunOutcome& outcome);

/// The same: "exit_status" and "steps", each with "subject", "trial" (null: of the subject), "step",
/// "command", "outputs", "status", "exit_status", "seconds" and "said".
[[nodiscard]] nlohmann::ordered_json run_json(const RunOutcome& outcome);

/// The commands of a run, a line each, as they would be typed in a shell.
[[nodiscard]] std::string commands_text(const RunOutcome& outcome);

}  // namespace kinemark::pipeline
