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

/// Text on standard output; whether all of it got there is asked once, by output_failed().
void print_result(std::string_view text);
/// Whether something of what was printed on standard output is lost.
[[nodiscard]] bool output_failed();

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
/// rate and time left; silent for the first second and with --quiet.
[[nodiscard]] Progress show_progress(const CommonOptions& common, std::string what);

/// From here on SIGINT, SIGTERM and SIGHUP (unless it is ignored, as under nohup) end the program at once,
/// whatever it does or waits for: a thread of their own removes what is half-written, says one sentence, and
/// ends with 128 + the signal's number. A reader of standard output that went away (SIGPIPE) and a file that
/// grows beyond the limit (ulimit -f) are failures to write. To be called before any other thread is made.
void watch_signals();

/// From here on the first of these signals ends nothing: signal_that_came() tells of it, and the command ends
/// by itself. The second one ends the program at once.
void end_gently();
/// Number of the signal that came after end_gently(); 0: none.
[[nodiscard]] int signal_that_came();

}  // namespace kinemark::cli
