// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/console.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/temporary.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

/// Number of the signal that somebody ends his work for by himself; -1: nobody does.
std::atomic<int> ended_gently = -1;

/// Wait for one of the signals, which every thread has blocked, and end the program. Files that get their
/// names in this moment get all of them. Where work is ended gently the first one is noted alone.
[[noreturn]] void end_by_signal(sigset_t signals) {
  int number = 0;
  while (sigwait(&signals, &number) != 0) continue;
  if (int nobody = 0; ended_gently.compare_exchange_strong(nobody, number))
    while (sigwait(&signals, &number) != 0) continue;
  std::fprintf(stderr, "kinemark: the command was stopped (%s)\n",
               number == SIGINT    ? "SIGINT"
               : number == SIGTERM ? "SIGTERM"
                                   : "SIGHUP");
  io::end_process(128 + number);
}

bool is_ignored(int number) {
  struct sigaction action{};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void say(const CommonOptions& common, std::string_view line) {
  if (!common.quiet) std::fprintf(stderr, "%s\n", printable_sentence(line).c_str());
}

void settle(const CommonOptions& common, std::string counts, pipeline::JobSettings& job) {
  job.threads = common.threads;
  job.seed = common.seed;
  job.force = common.force;
  job.kept = common.kept;
  job.command_line = common.command_line;
  job.progress = show_progress(common, std::move(counts));
}

void say_written(const CommonOptions& common, const pipeline::JobOutcome& outcome) {
  for (const auto& path : outcome.written) say(common, fmt::format("wrote {}", path.string()));
}

void print_written(const CommonOptions& common, const pipeline::JobOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, fmt::format("note: {}", warning));
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::outcome_json(outcome)) + "\n");
}

void print_result(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

bool output_failed() { return std::fflush(stdout) != 0 || std::ferror(stdout) != 0; }

int report_error(const Error& error) {
  std::fprintf(stderr, "kinemark: %s\n", printable_sentence(error.message).c_str());
  return exit_status(error.code);
}

Progress show_progress(const CommonOptions& common, std::string what) {
  using Clock = std::chrono::steady_clock;
  struct State {
    Clock::time_point start = Clock::now(), next = start + std::chrono::seconds(1);
    std::int64_t said = 0;
  };
  const auto state = std::make_shared<State>();
  const bool quiet = common.quiet, terminal = isatty(STDERR_FILENO) != 0;
  return [quiet, terminal, state, what = std::move(what)](std::int64_t done, std::int64_t total) {
    const auto now = Clock::now();
    if (quiet || now < state->next) return true;
    // Where lines are kept, one that says nothing new is left out.
    if (!terminal && (done == 0 || done == state->said)) return true;
    state->said = done;
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

void end_gently() {
  int nobody = -1;
  ended_gently.compare_exchange_strong(nobody, 0);
}

int signal_that_came() { return std::max(0, ended_gently.load()); }

void watch_signals() {
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  if (!is_ignored(SIGHUP)) sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(end_by_signal, signals).detach();
}

}  // namespace kinemark::cli
