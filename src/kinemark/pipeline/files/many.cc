// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/many.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/recording.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// What is there of the output of a recording.
enum class Presence { none, part, whole };

/// The files of a recording that say how far a run came.
struct Made {
  fs::path output, report, page;  ///< the last two empty where the job makes none
};

Made made_for(const ManyJob& job, const TrialOutcome& trial) {
  Made made{.output = trial.output, .report = {}, .page = {}};
  if (!job.belongs.empty()) made.report = beside(trial.output, job.belongs);
  if (!job.pages.empty()) made.page = job.pages / (trial.output.stem().string() + ".html");
  return made;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Presence presence_of(const Made& made) {
  int needed = 0, there = 0;
  for (const auto& file : {made.output, made.report, made.page}) {
    needed += file.empty() ? 0 : 1;
    there += !file.empty() && is_there(file) ? 1 : 0;
  }
  if (there == 0) return Presence::none;
  if (there < needed) return Presence::part;
  if (made.report.empty()) return Presence::whole;
  // A table of numbers alone (CSV) cannot name its set.
  const std::string set = set_in(made.output);
  return set.empty() || set == set_in(made.report) ? Presence::whole : Presence::part;
}

/// Whether all that is there was made by a run that did not come to its end: each file names its set. The
/// output comes last, so that one that cannot name a set (CSV) is not there then.
bool is_ours(const Made& made) {
  return std::ranges::all_of(std::array{made.output, made.report, made.page},
                             [](const fs::path& file) { return !is_there(file) || !set_in(file).empty(); });
}

bool is_older(const fs::path& output, const fs::path& input) {
  std::error_code a, b;
  const auto made = fs::last_write_time(output, a), recorded = fs::last_write_time(input, b);
  return !a && !b && made < recorded;
}

Result<std::vector<TrialOutcome>> plan(const ManyJob& job) {
  std::vector<TrialOutcome> trials;
  std::map<std::string, fs::path> taken;
  std::vector<fs::path> outputs;
  for (const auto& input : job.inputs) {
    const std::string ending = job.ending.empty() ? ending_of(input) : job.ending;
    TrialOutcome trial{.input = input, .output = job.folder / (input.stem().string() + ending)};
    std::string name = trial.output.filename().string();
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (const auto [other, is_new] = taken.emplace(name, input); !is_new)
      return fail(Code::usage,
                  fmt::format("{} and {} would both become {}; give them in two runs, into two folders",
                              other->second.string(), input.string(), trial.output.string()));
    outputs.push_back(trial.output);
    trials.push_back(std::move(trial));
  }
  if (auto s = check_apart(job, outputs, job.inputs); !s) return std::unexpected(s.error());
  for (const auto& folder : {job.folder, job.pages}) {
    if (folder.empty()) continue;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder, error))
      return fail(Code::io, fmt::format("{}: is no folder, and none can be made", folder.string()));
  }
  return trials;
}

/// A recording that is too large for the memory, or that trips a check, is one that failed.
Result<JobOutcome> run_guarded(const ManyJob& job, const TrialOutcome& trial, const fs::path& page,
                               const JobSettings& settings) {
  try {
    return job.run_one(trial.input, trial.output, page, settings);
  } catch (const std::bad_alloc&) {
    return fail(Code::io, fmt::format("{}: out of memory", trial.input.string()));
  } catch (const std::exception& error) {
    return fail(Code::bad_input, fmt::format("{}: {}", trial.input.string(), error.what()));
  }
}

void run_trial(const ManyJob& job, TrialOutcome& trial) {
  const Made made = made_for(job, trial);
  const Presence presence = presence_of(made);
  if (presence == Presence::whole && !job.force) {
    trial.status = is_older(trial.output, trial.input) ? TrialStatus::outdated : TrialStatus::there;
    if (trial.status == TrialStatus::outdated) trial.exit_status = 1, trial.said = "--force makes it anew";
    return;
  }
  JobSettings settings = job;
  settings.progress = {};
  for (const auto& input : job.inputs)
    std::ranges::move(pipeline::files_of(input, {}), std::back_inserter(settings.kept));
  settings.threads = std::max(1, thread_count(job.threads) / thread_count(job.jobs));
  settings.force = job.force || (presence == Presence::part && is_ours(made));
  const auto begin = std::chrono::steady_clock::now();
  const auto outcome = run_guarded(job, trial, made.page, settings);
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!outcome) {
    trial.status = TrialStatus::failed;
    trial.said = outcome.error().message;
    trial.exit_status = exit_status(outcome.error().code);
    return;
  }
  trial.exit_status = outcome->exit_status();
  trial.status = trial.exit_status == 0 ? TrialStatus::good : TrialStatus::missed_gate;
  trial.warnings = outcome->warnings.size();
  const auto missed = std::ranges::find(outcome->gates, false, &data::Gate::passed);
  if (missed != outcome->gates.end())
    trial.said = missed->sentence;
  else if (!outcome->warnings.empty())
    trial.said = outcome->warnings.front();
}

}  // namespace

std::string_view to_string(TrialStatus status) {
  switch (status) {
    case TrialStatus::good:
      return "good";
    case TrialStatus::missed_gate:
      return "missed a gate";
    case TrialStatus::there:
      return "there already";
    case TrialStatus::outdated:
      return "older than its input";
    case TrialStatus::failed:
      return "failed";
    case TrialStatus::not_begun:
      return "not begun";
  }
  return "";
}

int ManyOutcome::exit_status() const {
  int worst = 0;
  for (const auto& trial : trials) worst = std::max(worst, trial.exit_status);
  return worst;
}

Result<ManyOutcome> run_many(const ManyJob& job) {
  auto trials = plan(job);
  if (!trials) return std::unexpected(trials.error());
  ManyOutcome out{.trials = std::move(*trials)};
  std::mutex mutex;
  std::size_t next = 0;
  std::int64_t done = 0;
  bool stopped = false;
  const auto work = [&] {
    while (true) {
      std::size_t i = 0;
      {
        const std::lock_guard lock(mutex);
        if (stopped || next == out.trials.size()) return;
        i = next++;
      }
      run_trial(job, out.trials[i]);
      const std::lock_guard lock(mutex);
      stopped = stopped || (out.trials[i].status == TrialStatus::failed && !job.keep_going);
      ++done;
      if (job.progress && !job.progress(done, std::ssize(out.trials))) stopped = true;
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int n = 1; n < thread_count(job.jobs); ++n) workers.emplace_back(work);
    work();
  }
  return out;
}

}  // namespace kinemark::pipeline
