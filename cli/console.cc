// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/console.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/files/outcome_json.h"

namespace kinemark::cli {
namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void note_signal(int number) {
  signal_seen = number;
  std::signal(number, SIG_DFL);  // a second one kills
}

}  // namespace

void say(const CommonOptions& common, std::string_view line) {
  if (!common.quiet) std::fprintf(stderr, "%s\n", printable_sentence(line).c_str());
}

void settle(const CommonOptions& common, std::string counts, pipeline::JobSettings& job) {
  job.threads = common.threads;
  job.seed = common.seed;
  job.force = common.force;
  job.command_line = common.command_line;
  job.progress = show_progress(common, std::move(counts));
}

void say_written(const CommonOptions& common, const pipeline::JobOutcome& outcome) {
  for (const auto& path : outcome.written) say(common, fmt::format("wrote {}", path.string()));
}

void print_written(const CommonOptions& common, const pipeline::JobOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, fmt::format("note: {}", warning));
  say_written(common, outcome);
  if (common.json) fmt::print("{}\n", pipeline::json_text(pipeline::outcome_json(outcome)));
}

int report_error(const Error& error) {
  std::fprintf(stderr, "kinemark: %s\n", printable_sentence(error.message).c_str());
  if (error.code == Code::cancelled && caught_signal() != 0) return 128 + caught_signal();
  return exit_status(error.code);
}

Progress show_progress(const CommonOptions& common, std::string what) {
  using Clock = std::chrono::steady_clock;
  struct State {
    Clock::time_point start = Clock::now(), next = start + std::chrono::seconds(1);
  };
  const auto state = std::make_shared<State>();
  const bool quiet = common.quiet, terminal = isatty(STDERR_FILENO) != 0;
  return [quiet, terminal, state, what = std::move(what)](std::int64_t done, std::int64_t total) {
    if (caught_signal() != 0) return false;
    const auto now = Clock::now();
    if (quiet || now < state->next) return true;
    state->next = now + (terminal ? std::chrono::milliseconds(200) : std::chrono::milliseconds(1000));
    const double elapsed = std::chrono::duration<double>(now - state->start).count();
    const double rate = static_cast<double>(done) / elapsed;
    // Large pieces may take more than a second each; there is no estimate before the first is done.
    const std::string pace =
        done == 0 ? std::string()
                  : fmt::format(", {:.{}f} per {}, {:.0f} s left", rate < 1.0 ? 60.0 * rate : rate,
                                rate < 1.0 ? 1 : 0, rate < 1.0 ? "minute" : "second",
                                static_cast<double>(total - done) / rate);
    std::fprintf(stderr, "%s%s: %lld of %lld%s%s", terminal ? "\r" : "", what.c_str(),
                 static_cast<long long>(done), static_cast<long long>(total), pace.c_str(),
                 terminal ? "\033[K" : "\n");
    return true;
  };
}

void install_signal_handlers() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

int caught_signal() { return signal_seen; }

}  // namespace kinemark::cli
