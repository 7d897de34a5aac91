// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/motion_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"

namespace kinemark::pipeline {

namespace fs = std::filesystem;

fs::path beside(const fs::path& output, const std::string& suffix) {
  return output.parent_path() / (output.stem().string() + suffix);
}

namespace internal {
namespace {

/// Where to write what will become `target`.
fs::path staged(const Staging& staging, const fs::path& target) {
  const auto& targets = staging.targets();
  const auto found = std::find(targets.begin(), targets.end(), target);
  check(found != targets.end(), "put() needs a target of the staging");
  return staging.path(static_cast<std::size_t>(found - targets.begin()));
}

}  // namespace

Status check_named(const MotionJob& job, std::string_view or_else) {
  if (job.model.empty()) return fail(Code::usage, fmt::format("no model; give --model{}", or_else));
  if (job.markers.empty()) return fail(Code::usage, fmt::format("no marker file; give --markers{}", or_else));
  if (job.output.empty()) return fail(Code::usage, fmt::format("no output; give --output{}", or_else));
  return job.images.check();
}

Result<MotionInputs> read_inputs(const MotionJob& job) {
  auto description = io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  if (description->markers.empty())
    return fail(Code::bad_input, fmt::format("{}: model '{}' has no markers; need at least one",
                                             job.model.string(), description->name));
  auto trial = io::read_markers(job.markers, {.rate_hz = job.rate_hz});
  if (!trial) return std::unexpected(trial.error());
  auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(job.model.string(), model.error());
  MotionInputs inputs{.model = std::move(*model), .trial = std::move(*trial), .images = {}};
  if (!job.images.any()) return inputs;
  auto images = read_images(job.images, inputs.trial.markers.time);
  if (!images) return std::unexpected(images.error());
  inputs.images = std::move(*images);
  return inputs;
}

Result<report::IkRun> begin_run(const MotionJob& job, const MotionInputs& inputs) {
  const auto& model = inputs.model.description();
  report::IkRun run;
  run.trial = job.markers.filename().string();
  run.model = model.name;
  run.version = kVersion;
  run.command_line = job.command_line;
  run.warnings = inputs.trial.warnings;
  run.warnings.insert(run.warnings.end(), model.warnings.begin(), model.warnings.end());
  for (const auto& coordinate : model.coordinates)
    if (coordinate.locked) run.locked_coordinates.push_back(coordinate.name);
  if (auto s = add_input(run, "model", job.model); !s) return std::unexpected(s.error());
  if (auto s = add_input(run, "markers", job.markers); !s) return std::unexpected(s.error());
  if (!inputs.images) return run;
  if (auto s = add_input(run, "rig", job.images.rig); !s) return std::unexpected(s.error());
  for (const auto& file : job.images.cameras)
    if (auto s = add_input(run, "images", file.points); !s) return std::unexpected(s.error());
  std::string unknown;
  for (const auto& name : inputs.images->names)
    if (model.find_marker(name) < 0) unknown += (unknown.empty() ? "" : ", ") + name;
  if (!unknown.empty())
    run.warnings.push_back("the model has no marker for these points of the images: " + unknown);
  return run;
}

Status add_torque_account(report::IkRun& run, const TorqueAccount& account) {
  run.options.insert(run.options.end(), account.facts.begin(), account.facts.end());
  run.warnings.insert(run.warnings.end(), account.warnings.begin(), account.warnings.end());
  for (const auto& file : account.files)
    if (auto s = add_input(run, "forces", file); !s) return s;
  return {};
}

Status add_input(report::IkRun& run, const char* role, const fs::path& path) {
  if (path.empty()) return {};
  const auto hash = hash_file(path);
  if (!hash) return std::unexpected(hash.error());
  run.inputs.push_back(
      {.role = role, .path = path.string(), .bytes = hash->bytes, .hash = hash->hex, .hash_kind = "XXH3-64"});
  return {};
}

void add_fit(report::IkRun& run, data::MarkerFit fit, const TimeBase& time) {
  run.fit = std::move(fit);
  std::ranges::move(run.fit.warnings, std::back_inserter(run.warnings));
  run.fit.warnings.clear();
  for (const auto& finding : run.fit.findings) run.warnings.push_back(data::describe(finding, time));
}

void add_gate(report::IkRun& run, std::string name, double value, double bound, std::string unit,
              std::string sentence) {
  const bool passed = value <= bound;
  run.gates.push_back({.name = std::move(name),
                       .passed = passed,
                       .value = value,
                       .bound = bound,
                       .unit = std::move(unit),
                       .sentence = std::move(sentence)});
  if (!passed) run.exit_status = 1;
}

void add_marker_gates(report::IkRun& run, const MotionJob& job, double offset_m, std::string offset_sentence,
                      double rms_m) {
  add_gate(run, "mean_marker_offset", 1e3 * offset_m, 1e3 * job.max_offset_m, "mm",
           std::move(offset_sentence));
  add_gate(run, "marker_rms", 1e3 * rms_m, 1e3 * job.max_rms_m, "mm",
           fmt::format("The RMS distance between measured and model markers is {:.1f} mm; at most {:.1f} mm "
                       "is accepted.",
                       1e3 * rms_m, 1e3 * job.max_rms_m));
}

Result<Staging> stage(const MotionJob& job, const std::vector<std::string>& suffixes,
                      const std::vector<fs::path>& further) {
  std::vector<fs::path> targets{job.output};
  for (const auto& suffix : suffixes) targets.push_back(beside(job.output, suffix));
  targets.insert(targets.end(), further.begin(), further.end());
  return Staging::create(std::move(targets), job.force);
}

Status put(const Staging& staging, const fs::path& target, const data::Table& table) {
  const auto written = io::write_table(staged(staging, target), table, {});
  return written ? written : Status(staging.failure(written.error()));
}

Status put(const Staging& staging, const fs::path& target, const std::string& text) {
  const auto written = io::write_text(staged(staging, target), text, false);
  return written ? written : Status(staging.failure(written.error()));
}

Status write_motion(const MotionJob& job, const Staging& staging, report::IkRun run,
                    const data::JointMotion& motion, const data::Trajectories* markers,
                    MotionOutcome& outcome) {
  outcome.exit_status = run.exit_status;
  auto summary = report::summarize(std::move(run), motion, markers);
  if (!summary) return std::unexpected(summary.error());
  outcome.summary = std::move(*summary);

  const auto& output = job.output;
  Status status = put(staging, output, coordinates_table(motion));
  const auto add = [&](const char* suffix, const Array<double>& values,
                       data::Table (*table)(const data::JointMotion&)) {
    if (status && !values.empty()) status = put(staging, beside(output, suffix), table(motion));
  };
  add("_sd.sto", motion.q_sd, deviations_table);
  add("_bound.sto", motion.q_bound, bounds_table);
  add("_tau.sto", motion.tau, torques_table);
  add("_tau_sd.sto", motion.tau_sd, torque_deviations_table);
  if (status) status = put(staging, beside(output, "_marker_errors.sto"), marker_errors_table(motion));
  if (status)
    status =
        put(staging, beside(output, "_report.json"), report::summary_json(outcome.summary).dump(2) + "\n");
  return status;
}

Status reveal(Staging& staging, const Progress& progress, std::string_view what, MotionOutcome& outcome) {
  const auto frames = outcome.summary.time.frames;
  if (progress && !progress(frames, frames))
    return fail(Code::cancelled, fmt::format("{} was stopped", what));
  std::vector<fs::path> written;
  for (std::size_t i = 0; i < staging.targets().size(); ++i)
    if (fs::exists(staging.path(i))) written.push_back(staging.targets()[i]);
  if (auto s = staging.commit(); !s) return s;
  outcome.written = std::move(written);
  return {};
}

}  // namespace internal
}  // namespace kinemark::pipeline
