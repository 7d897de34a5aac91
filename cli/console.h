// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <utility>

#include "cli/command.h"
#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::cli {

/// Print one line on stderr, except with --quiet; printable_sentence() makes it safe, here and in
/// report_error().
void say(const CommonOptions& common, std::string_view line);

/// Into the job what every command takes. @param counts  what its progress counts: "frames"
void settle(const CommonOptions& common, std::string counts, pipeline::JobSettings& job);

/// A line for each file that was written.
void say_written(const CommonOptions& common, const pipeline::JobOutcome& outcome);

/// What was written, after notes on it: lines for people, or {"written": [...], "warnings": [...]} on stdout.
void print_written(const CommonOptions& common, const pipeline::JobOutcome& outcome);

/// The sentence of a failure on stderr, and its exit status.
[[nodiscard]] int report_error(const Error& error);

/// The way of a command: settle the job, run it, print(globals, outcome); the exit status.
template <class Job, class RunJob, class Print>
[[nodiscard]] int run_job(const CommonOptions& common, std::string counts, Job& job, const RunJob& run,
                          const Print& print) {
  settle(common, std::move(counts), job);
  const auto outcome = run(job);
  if (!outcome) return report_error(outcome.error());
  print(common, *outcome);
  return outcome->exit_status();
}

/// Progress of long work on stderr: a line that is rewritten on a terminal, a line a second elsewhere, with
/// rate and time left; silent for the first second and with --quiet. Stops the work after SIGINT or SIGTERM.
[[nodiscard]] Progress show_progress(const CommonOptions& common, std::string what);

/// Signal that asked to stop (SIGINT or SIGTERM), or 0. install_signal_handlers() makes them be noted instead
/// of killing, and a file that grows beyond the limit (ulimit -f) be a failure to write it.
void install_signal_handlers();
[[nodiscard]] int caught_signal();

}  // namespace kinemark::cli
