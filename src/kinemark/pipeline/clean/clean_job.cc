// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/clean/clean_job.h"

#include <fmt/core.h>

#include <chrono>

#include "kinemark/core/enum_names.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/clean/internal/clean_account.h"
#include "kinemark/pipeline/clean/internal/clean_output.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "kinemark/stages/trajectory/screening/real_samples.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr EnumNames<RecorderMade::decimate> kRecorderMade{"keep", "mark", "missing", "decimate"};

/// Analog samples and residuals belong to the old frames.
void change_frames(data::Trial& trial, data::Trajectories markers, std::vector<std::string>& notes) {
  trial.residual_m.clear();
  trial.camera_mask.clear();
  trial.first_frame = 1;
  if (!trial.analog.names.empty()) {
    notes.push_back(fmt::format("{} analog channels were left out: they cannot be told by frames of {:g} Hz",
                                trial.analog.names.size(), markers.time.rate_hz));
    trial.analog = {};
    trial.force_plates.clear();
  }
  trial.markers = std::move(markers);
}

/// Look for what the recorder did, and do about it what the job says.
Result<trajectory::UpsamplingReport> screen_trial(const CleanJob& job, data::Trial& trial,
                                                  CleanOutcome& outcome) {
  auto& report = outcome.report;
  const auto findings = trajectory::screen(trial.markers);
  if (!findings) return std::unexpected(findings.error());
  internal::add_defects(report, *findings, job.reject_defects, trial.markers.names);
  auto upsampling = trajectory::detect_upsampling(trial.markers);
  if (!upsampling) return std::unexpected(upsampling.error());
  report.upsampling = internal::describe_upsampling(*upsampling, job.recorder_made);
  if (job.reject_defects) {
    auto rest = trajectory::reject_findings(trial.markers, *findings, internal::kRejectConfidence);
    if (!rest) return std::unexpected(rest.error());
    trial.markers = std::move(*rest);
  }
  if (job.recorder_made == RecorderMade::keep || report.upsampling.factor == 1) return upsampling;
  const auto made = job.recorder_made == RecorderMade::mark      ? trajectory::MadeSamples::mark
                    : job.recorder_made == RecorderMade::missing ? trajectory::MadeSamples::missing
                                                                 : trajectory::MadeSamples::decimate;
  auto real = trajectory::keep_real_samples(trial.markers, *upsampling, made);
  if (!real) return std::unexpected(real.error());
  if (real->frames() == trial.markers.frames())
    trial.markers = std::move(*real);
  else
    change_frames(trial, std::move(*real), outcome.notes);
  return upsampling;
}

/// Smooth marker by marker, each into the report and to the output as soon as it is done.
Status smooth_trial(const CleanJob& job, const data::Trajectories& before,
                    const trajectory::UpsamplingReport& upsampling, const data::Trial& trial,
                    internal::CleanOutput& output, report::CleanReport& report, const Progress& progress) {
  auto options = job.filter;
  options.threads = job.threads;
  options.progress = progress;
  return trajectory::smooth_each(trial.markers, options, [&](trajectory::MarkerResult&& result) -> Status {
    const auto m = result.marker;
    auto facts = internal::describe_marker(result.account, upsampling, m);
    internal::MarkerPiece piece(std::move(result), trial.markers);
    report::add_marker(report, std::move(facts),
                       {.before = &before,
                        .before_marker = m,
                        .after = &piece.markers,
                        .after_marker = 0,
                        .derivatives = &piece.derivatives});
    return output.take(std::move(piece), m);
  });
}

Status fill_trial(const CleanJob& job, data::Trial& trial, report::CleanReport& report) {
  if (job.gaps.method == trajectory::GapMethod::none) return {};
  auto options = job.gaps;
  options.seed = job.seed;
  options.threads = job.threads;
  auto filled = trajectory::fill_gaps(trial.markers, options);
  if (!filled) return std::unexpected(filled.error());
  internal::add_gaps(report, *filled, trial.markers.names);
  trial.markers = std::move(filled->trajectories);
  return {};
}

Result<data::Trial> read_input(const CleanJob& job, report::CleanRun& run) {
  auto trial = io::read_markers(job.input);
  if (!trial) return std::unexpected(trial.error());
  if (trial->markers.markers() == 0 || trial->markers.frames() == 0)
    return fail(Code::bad_input,
                fmt::format("{}: holds {} markers and {} frames; need at least one of each",
                            job.input.string(), trial->markers.markers(), trial->markers.frames()));
  const auto hash = hash_file(job.input);
  if (!hash) return std::unexpected(hash.error());
  run = internal::describe_run(job, *trial);
  run.inputs.push_back({"markers", job.input.string(), hash->bytes, hash->hex, "XXH3-64"});
  return trial;
}

}  // namespace

std::string_view to_string(RecorderMade made) { return kRecorderMade[made]; }

Result<RecorderMade> parse_recorder_made(std::string_view name) {
  return kRecorderMade.parse(name, "choice for samples that the recorder made");
}

Result<CleanOutcome> run_clean(const CleanJob& job, const Progress& progress) {
  const fs::path summary = beside(job.output, "_report.json");
  const fs::path table = beside(job.output, "_derivatives.sto");
  const bool with_table = job.derivatives && !internal::is_nwb(job.output);
  std::vector<fs::path> targets{job.output, summary};
  if (with_table) targets.push_back(table);
  if (!job.report.empty()) targets.push_back(job.report);
  auto staging = Staging::create(targets, job.force);
  if (!staging) return std::unexpected(staging.error());

  CleanOutcome outcome;
  report::CleanReport& report = outcome.report;
  auto read = read_input(job, report.run);
  if (!read) return std::unexpected(read.error());
  data::Trial& trial = outcome.trial = std::move(*read);
  const auto start = std::chrono::steady_clock::now();
  const auto upsampling = screen_trial(job, trial, outcome);
  if (!upsampling) return fail_at(job.input.string(), upsampling.error());
  const data::Trajectories before = trial.markers;
  if (auto s = fill_trial(job, trial, report); !s) return fail_at(job.input.string(), s.error());
  report.time = trial.markers.time;
  auto output = internal::CleanOutput::create(job, staging->path(0), trial, report.run);
  if (!output) return staging->failure(output.error());
  if (auto s = smooth_trial(job, before, *upsampling, trial, *output, report, progress); !s)
    return s.error().code == Code::io ? staging->failure(s.error()) : fail_at(job.input.string(), s.error());
  report.run.clean_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const auto write = [&]() -> Status {
    if (auto s = output->finish(trial, staging->path(with_table ? 2 : 0)); !s) return s;
    const std::string json = report::clean_summary_json(report).dump(2) + "\n";
    if (auto s = io::write_text(staging->path(1), json, false); !s) return s;
    if (job.report.empty()) return {};
    return io::write_text(staging->path(targets.size() - 1), report::clean_report_html(report), false);
  };
  if (auto s = write(); !s) return staging->failure(s.error());
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  outcome.written = targets;
  return outcome;
}

}  // namespace kinemark::pipeline
