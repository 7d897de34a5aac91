// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/vsk/vsk.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/joints/joints_json.h"
#include "kinemark/pipeline/joints/limb_figure.h"
#include "kinemark/pipeline/joints/segments_file.h"
#include "kinemark/workflow/prepare/screen_axes.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

bool into_folder(const fs::path& output) { return !output.has_extension() || fs::is_directory(output); }

Status check_options(const JointsJob& job) {
  if (auto s = job.JointsMethod::check(); !s) return s;
  if (!job.figures.empty() && ending_of(job.figures) != ".svg")
    return fail(Code::usage, fmt::format("{}: figures are .svg; '{}' is another ending", job.figures.string(),
                                         ending_of(job.figures)));
  if (!job.output.empty() && !into_folder(job.output)) return io::check_marker_format(job.output);
  return {};
}

/// Segments of a file of the job's, of the markers by their names.
Status read_layout(const JointsJob& job, const std::vector<std::string>& markers,
                   workflow::JointsOptions& options, JointsOutcome& outcome) {
  if (job.segments.empty()) return {};
  options.of_subject = io::is_vsk_ending(ending_of(job.segments));
  if (!options.of_subject) {
    auto layout = read_segments(job.segments, markers);
    if (!layout) return std::unexpected(layout.error());
    options.segments = std::move(*layout);
    return {};
  }
  const auto vsk = io::read_vsk(job.segments);
  if (!vsk) return std::unexpected(vsk.error());
  auto layout = layout_of(*vsk, markers, outcome.warnings);
  if (!layout) return fail_at(job.segments.string(), layout.error());
  options.segments = std::move(*layout);
  return {};
}

/// What is found, with what was said of it behind what was said before.
void take(workflow::JointsFound found, JointsOutcome& outcome) {
  auto remarks = std::exchange(found.remarks, {});
  static_cast<workflow::JointsFound&>(outcome) = std::move(found);
  std::ranges::move(remarks.warnings, std::back_inserter(outcome.warnings));
  outcome.gates = std::move(remarks.gates);
}

Result<Staging> stage(const JointsJob& job) {
  const auto& output = job.output;
  auto inputs = files_of(job.input, job);
  inputs.push_back(job.segments);
  if (output.empty()) return Staging::create({}, job, inputs);
  if (!into_folder(output)) return Staging::create({output, beside(output, "_skeleton.json")}, job, inputs);
  return Staging::create_in(output, {"centres.csv", "skeleton.json", "centres.c3d", "segments.toml"}, job,
                            inputs);
}

std::vector<ResultFile> list_files(const JointsJob& job, const JointsOutcome& outcome,
                                   const data::Trial& centres, const Eigen::Vector3d& up,
                                   const std::vector<fs::path>& targets) {
  std::vector<ResultFile> files;
  for (const auto& target : targets) {
    if (target == job.report) {
      files.push_back(text_file(target, [&] { return joints_page(job, outcome, centres.first_frame); }));
      continue;
    }
    if (outcome.skeleton.joints.empty() && target.extension() != ".json") continue;
    if (target == job.figures) {
      files.push_back(text_file(target, [&] { return limb_figure(outcome.used, outcome.skeleton, up); }));
      continue;
    }
    files.push_back(target.extension() == ".json"
                        ? json_file(target, [&] { return joints_json(job, outcome); })
                    : target.extension() == ".toml"
                        ? toml_file(target, [&] { return segments_text(outcome.layout, outcome.markers); })
                        : marker_file(target, centres));
  }
  return files;
}

std::string name_set(const JointsJob& job, const JointsOutcome& outcome, const data::Trial& centres) {
  SetDigest digest;
  digest.add("joints").add(std::vector{outcome.input}).add(job.method).add(centres.markers);
  return digest.add(std::span<const double>(centres.markers.covariance))
      .add(segments_text(outcome.layout, outcome.markers))
      .hex();
}

}  // namespace

Result<JointsOutcome> run_joints(const JointsJob& job) {
  // Prepare: markers, segments, where results go.
  if (auto s = check_options(job); !s) return std::unexpected(s.error());
  auto recording = open_recording({.path = job.input,
                                   .needs_samples = true,
                                   .record = true,
                                   .force = job.force,
                                   .seed = job.seed,
                                   .threads = job.threads},
                                  job);
  if (!recording) return std::unexpected(recording.error());
  JointsOutcome outcome;
  outcome.input = std::move(recording->file);
  outcome.warnings = std::move(recording->notes);
  workflow::JointsOptions options;
  static_cast<workflow::JointsMethod&>(options) = job;
  options.drop_doubtful = job.drops_doubtful(true);
  options.threads = job.threads;
  options.progress = job.progress;
  if (auto s = read_layout(job, recording->trial.markers.names, options, outcome); !s)
    return std::unexpected(s.error());
  auto staging = stage(job);
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  if (!job.figures.empty())
    if (auto s = staging->add({job.figures}); !s) return std::unexpected(s.error());
  staging->add_inputs(std::vector{outcome.input});
  // Solve and judge.
  auto found = workflow::joints(*recording, options);
  if (!found) return fail_at(job.input.string(), found.error());
  take(std::move(*found), outcome);
  // Write.
  data::Trial centres;
  centres.source = recording->trial.source;
  centres.first_frame = recording->trial.first_frame;
  if (auto lost =
          io::lost_beside(into_folder(job.output) ? ".csv" : ending_of(job.output), recording->trial.beside);
      !lost.empty() && !job.output.empty())
    outcome.warnings.push_back(std::move(lost));
  centres.beside = std::move(recording->trial.beside);
  centres.markers = workflow::centre_trajectories(outcome.skeleton);
  centres.calibration_error = recording->trial.calibration_error;
  if (const auto up = workflow::stated_vertical(job.axes)) workflow::set_screen_up(centres, up->up);
  const Eigen::Vector3d up = workflow::screen_up(centres).value_or(
      workflow::screen_up(recording->trial).value_or(Eigen::Vector3d(Eigen::Vector3d::UnitZ())));
  auto written = write_results(*staging, list_files(job, outcome, centres, up, staging->targets()), {},
                               "the search for joints", name_set(job, outcome, centres));
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

}  // namespace kinemark::pipeline
