// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/clean/clean_job.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/clean/internal/clean_output.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "kinemark/workflow/clean/clean.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// The files of a run. Those that are not asked for are empty.
struct CleanFiles {
  fs::path recording, summary, derivatives, page;

  explicit CleanFiles(const CleanJob& job)
      : recording(job.output), summary(beside(job.output, "_report.json")), page(job.report) {
    if (job.derivatives && !internal::is_nwb(job.output))
      derivatives = beside(job.output, "_derivatives.sto");
  }
  [[nodiscard]] std::vector<fs::path> all() const {
    std::vector<fs::path> files{recording, summary};
    for (const auto* more : {&derivatives, &page})
      if (!more->empty()) files.push_back(*more);
    return files;
  }
};

workflow::RepairOptions repair_options(const CleanJob& job) {
  return {.recorder_made = job.recorder_made,
          .exchange_back = job.exchange_back,
          .reject_doubtful = job.drops_doubtful(false),
          .gaps = job.gaps,
          .seed = job.seed,
          .threads = job.threads};
}

/// Smooth marker by marker, each into the report and to the output as soon as it is done.
Status smooth_trial(const CleanJob& job, const workflow::Repaired& repaired, const data::Trial& trial,
                    internal::CleanOutput& output, report::CleanReport& report) {
  const auto& before = repaired.before;
  auto options = job.filter;
  options.leave = repaired.apart.all();
  options.threads = job.threads;
  options.progress = job.progress;
  return trajectory::smooth_each(trial.markers, options, [&](trajectory::MarkerResult&& result) -> Status {
    const auto m = result.marker;
    data::MarkerAccount account = result.account;
    internal::MarkerPiece piece(std::move(result), trial.markers);
    report::add_marker(report, std::move(account),
                       {.before = &before,
                        .before_marker = m,
                        .after = &piece.markers,
                        .after_marker = 0,
                        .derivatives = &piece.derivatives});
    return output.take(std::move(piece), m);
  });
}

/// Recording and derivatives were put as they came; the account of it all follows.
std::vector<ResultFile> list_files(const CleanFiles& files, internal::CleanOutput& output,
                                   CleanOutcome& outcome, const Staging& staging) {
  std::vector<ResultFile> list;
  list.push_back({files.recording, [&](const fs::path&, const std::string& set) {
                    return output.finish(
                        outcome.trial,
                        files.derivatives.empty() ? fs::path() : staging.path_of(files.derivatives), set,
                        outcome.warnings);
                  }});
  list.push_back(json_file(files.summary, [&] { return report::clean_summary_json(outcome.report); }));
  if (!files.page.empty())
    list.push_back(text_file(files.page, [&] { return report::clean_report_html(outcome.report); }));
  return list;
}

}  // namespace

Result<CleanOutcome> run_clean(const CleanJob& job) {
  // Prepare: where results go, markers, and what the recorder did to them.
  if (auto s = job.gaps.check(); !s) return std::unexpected(s.error());
  if (auto s = io::check_marker_format(job.output); !s) return std::unexpected(s.error());
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  const CleanFiles files(job);
  auto staging = Staging::create(files.all(), job, files_of(job.input, job));
  if (!staging) return std::unexpected(staging.error());
  const RecordingSource source{.path = job.input,
                               .needs_samples = true,
                               .record = true,
                               .force = job.force,
                               .seed = job.seed,
                               .threads = job.threads};
  auto recording = read_recording(source, job);
  if (!recording) return std::unexpected(recording.error());
  const bool smooths = job.filter.method != trajectory::FilterMethod::none;
  const std::string filtered = workflow::begin_unfiltered(recording->trial.markers, smooths);
  if (auto s = prepare_recording(source, job, *recording); !s) return std::unexpected(s.error());
  CleanOutcome outcome;
  auto& report = outcome.report;
  report.run = internal::describe_run(job, recording->trial);
  if (!filtered.empty()) report.run.warnings.push_back(filtered);
  report.run.inputs.push_back(std::move(recording->file));
  if (recording->journal.file) report.run.inputs.push_back(*recording->journal.file);
  std::ranges::move(edit_options(recording->edits, recording->journal),
                    std::back_inserter(report.run.options));
  std::ranges::copy(recording->notes, std::back_inserter(report.run.warnings));
  const auto start = std::chrono::steady_clock::now();
  auto repaired = workflow::repair(std::move(*recording), repair_options(job));
  if (!repaired) return fail_at(job.input.string(), repaired.error());
  report.account = std::move(repaired->account);
  outcome.warnings = std::move(repaired->remarks.warnings);
  report.run.gates = outcome.gates = std::move(repaired->remarks.gates);
  report.run.exit_status = outcome.exit_status();
  // Smooth: each marker goes into the output as soon as it is done.
  auto& trial = outcome.trial = std::move(repaired->recording.trial);
  report.time = trial.markers.time;
  auto output = internal::CleanOutput::create(job, staging->path_of(files.recording), trial, report.run);
  if (!output) return staging->failure(output.error());
  if (auto s = smooth_trial(job, *repaired, trial, *output, report); !s)
    return s.error().code == Code::io ? staging->failure(s.error()) : fail_at(job.input.string(), s.error());
  report.run.clean_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Write.
  const std::string set = SetDigest()
                              .add(report.run.version)
                              .add(report.run.inputs)
                              .add(report.run.options)
                              .add(output->cleaned())
                              .hex();
  auto written = write_results(*staging, list_files(files, *output, outcome, *staging), {}, "cleaning", set);
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

}  // namespace kinemark::pipeline
