// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/motion_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/keypoints/keypoints_file.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/model_input.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/workflow/motion/ik.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::pipeline::internal {

namespace fs = std::filesystem;

namespace {

/// Images at the frames of the trial; their files go into the record.
Status add_images(const MotionJob& job, MotionInputs& inputs) {
  if (!job.images.any()) return {};
  auto images = read_images(job.images, inputs.recording.trial.markers.time);
  if (!images) return std::unexpected(images.error());
  inputs.images = std::move(*images);
  auto file = io::record_input("rig", job.images.rig);
  if (!file) return std::unexpected(file.error());
  inputs.files.push_back(std::move(*file));
  for (const auto& [camera, points] : job.images.cameras) {
    const auto files = io::keypoints_files(points);
    if (!files) return std::unexpected(files.error());
    file = io::record_inputs("images", points, *files);
    if (!file) return std::unexpected(file.error());
    inputs.files.push_back(std::move(*file));
  }
  return {};
}

}  // namespace

Status check_named(const MotionJob& job, std::string_view or_else) {
  if (job.model.empty()) return fail(Code::usage, fmt::format("no model; give --model{}", or_else));
  if (job.markers.empty()) return fail(Code::usage, fmt::format("no marker file; give --markers{}", or_else));
  if (auto s = job.RecordingOptions::check(); !s) return s;
  return job.images.check();
}

Status check_output_named(const MotionJob& job, std::string_view or_else) {
  if (job.output.empty()) return fail(Code::usage, fmt::format("no output; give --output{}", or_else));
  return check_ending(job.output, {".mot", ".sto"}, "joint angles are");
}

Result<MotionInputs> read_inputs(const MotionJob& job) {
  if (auto s = check_geometry(job.geometry); !s) return std::unexpected(s.error());
  auto model = read_model_input(job.model);
  if (!model) return std::unexpected(model.error());
  RecordingOptions options = job;
  options.selection = job.selection.without_times();
  auto recording = open_recording({.path = job.markers,
                                   .record = true,
                                   .plates = !job.forces.empty(),
                                   .contact_force_n = motion::DynamicsOptions{}.contact_force_n,
                                   .forces = job.forces,
                                   .one_time = true,
                                   .turns = false,
                                   .force = job.force,
                                   .seed = job.seed,
                                   .threads = job.threads},
                                  options);
  if (!recording) return std::unexpected(recording.error());
  const auto& markers = recording->trial.markers;
  auto made = workflow::note_on_upsampling(markers);
  if (!made) return fail_at(job.markers.string(), made.error());
  if (!made->empty()) recording->trial.warnings.push_back(std::move(*made));
  const auto axes = workflow::bring_into_axes(job.axes, job.markers.string(), *recording, model->model);
  if (!axes) return std::unexpected(axes.error());
  if (job.images.any() && !axes->model_from_recording.isIdentity(0.0))
    return fail(
        Code::usage,
        "images are seen in the axes of their rig, which --up and --rotate do not turn; turn the model");
  MotionInputs inputs{.model = std::move(model->model),
                      .recording = std::move(*recording),
                      .images = {},
                      .files = {std::move(model->file)}};
  inputs.files.push_back(inputs.recording.file);
  if (inputs.recording.journal.file) inputs.files.push_back(*inputs.recording.journal.file);
  std::ranges::copy(inputs.recording.forces, std::back_inserter(inputs.files));
  if (auto s = add_images(job, inputs); !s) return std::unexpected(s.error());
  return inputs;
}

report::IkRun begin_run(const MotionJob& job, const MotionInputs& inputs) {
  const auto& model = inputs.model.description();
  report::IkRun run;
  run.trial = job.markers.filename().string();
  run.model = model.name;
  run.version = kVersion;
  run.command_line = job.command_line;
  run.seed = job.seed;
  run.threads = job.threads;
  run.inputs = inputs.files;
  run.options = edit_options(inputs.recording.edits, inputs.recording.journal);
  run.warnings = inputs.recording.trial.warnings;
  if (auto note = data::note_on_noise(inputs.recording.trial.markers); !note.empty())
    run.warnings.push_back(std::move(note));
  run.warnings.insert(run.warnings.end(), inputs.recording.notes.begin(), inputs.recording.notes.end());
  if (auto lost =
          io::lost_beside(job.into_nwb ? ".nwb" : ending_of(job.output), inputs.recording.trial.beside);
      !lost.empty() && !job.output.empty())
    run.warnings.push_back(std::move(lost));
  run.warnings.insert(run.warnings.end(), model.warnings.begin(), model.warnings.end());
  for (const auto& coordinate : model.coordinates)
    if (coordinate.locked)
      run.locked_coordinates.push_back(coordinate.name);
    else if (coordinate.clamped && !coordinate.prescribed)
      run.limits.push_back({coordinate.name, coordinate.range_min, coordinate.range_max});
  double mass_kg = 0.0;
  for (const auto& body : model.bodies) mass_kg += body.mass;
  if (mass_kg > 0.0) run.mass_kg = mass_kg;
  if (!inputs.images) return run;
  std::string unknown;
  for (const auto& name : inputs.images->names)
    if (model.find_marker(name) < 0) unknown += (unknown.empty() ? "" : ", ") + name;
  if (!unknown.empty())
    run.warnings.push_back("the model has no marker for these points of the images: " + unknown);
  return run;
}

Status add_input(report::IkRun& run, const char* role, const fs::path& path) {
  if (path.empty()) return {};
  auto file = io::record_input(role, path);
  if (!file) return std::unexpected(file.error());
  run.inputs.push_back(std::move(*file));
  return {};
}

void add_found(report::IkRun& run, const data::MarkerFit& fit, const workflow::TorqueAccount& torques,
               const workflow::Remarks& remarks) {
  run.fit = fit;
  run.fit.warnings.clear();  // they are among the remarks
  std::ranges::copy(torques.facts, std::back_inserter(run.options));
  std::ranges::copy(remarks.warnings, std::back_inserter(run.warnings));
  run.gates = remarks.gates;
  run.exit_status = remarks.passed() ? 0 : 1;
}

Result<Staging> stage(const MotionJob& job, const std::vector<std::string>& suffixes,
                      const std::vector<fs::path>& further, const std::vector<fs::path>& also_read) {
  std::vector<fs::path> targets{job.output};
  for (const auto& suffix : suffixes) targets.push_back(beside(job.output, suffix));
  if (job.into_nwb) targets.push_back(beside(job.output, kAnglesFile));
  targets.insert(targets.end(), further.begin(), further.end());
  auto inputs = files_of(job.markers, job);
  inputs.insert(inputs.end(), {job.model, job.forces, job.images.rig});
  for (const auto& camera : job.images.cameras) inputs.push_back(camera.points);
  inputs.insert(inputs.end(), also_read.begin(), also_read.end());
  return Staging::create(targets, job, inputs);
}

Status judge(report::IkRun run, const data::JointMotion& motion, const data::Trajectories* markers,
             MotionOutcome& outcome) {
  auto summary = report::summarize(std::move(run), motion, markers);
  if (!summary) return std::unexpected(summary.error());
  outcome.summary = std::move(*summary);
  outcome.gates = outcome.summary.run.gates;
  outcome.warnings = outcome.summary.run.warnings;
  return {};
}

std::vector<ResultFile> motion_files(const MotionJob& job, const data::JointMotion& motion,
                                     const report::IkSummary& summary, const nlohmann::ordered_json& more) {
  const auto& output = job.output;
  std::vector<ResultFile> files;
  const auto add = [&](const fs::path& target, data::Table (*table)(const data::JointMotion&)) {
    files.push_back(table_file(target, [&motion, table] { return table(motion); }));
  };
  add(output, coordinates_table);
  if (!motion.q_sd.empty()) add(beside(output, "_sd.sto"), deviations_table);
  if (!motion.q_bound.empty()) add(beside(output, "_bound.sto"), bounds_table);
  if (!motion.tau.empty()) add(beside(output, "_tau.sto"), torques_table);
  if (!motion.tau_sd.empty()) add(beside(output, "_tau_sd.sto"), torque_deviations_table);
  add(beside(output, "_marker_errors.sto"), marker_errors_table);
  files.push_back(json_file(beside(output, "_report.json"), [&summary, more] {
    auto json = report::summary_json(summary);
    if (more.is_object()) json.update(more);
    return json;
  }));
  return files;
}

std::string name_set(const data::JointMotion& motion, const report::IkRun& run) {
  SetDigest digest;
  digest.add(run.method).add(run.version).add(run.inputs).add(run.options).add(coordinates_table(motion));
  for (const auto* values :
       {&motion.q_sd, &motion.q_bound, &motion.tau, &motion.tau_sd, &motion.marker_error})
    digest.add(std::span<const double>(*values));
  for (const auto& gate : run.gates) digest.add(gate.name).add(std::array{gate.value, gate.bound});
  return digest.hex();
}

Status write(const MotionJob& job, Staging& staging, const std::vector<ResultFile>& files,
             std::string_view what, const data::JointMotion& motion, MotionOutcome& outcome) {
  // Some files are known to be inputs only now: those that others name.
  staging.add_inputs(outcome.summary.run.inputs);
  const auto frames = outcome.summary.time.frames;
  const auto go_on = [&](std::int64_t, std::int64_t) {
    return !job.progress || job.progress(frames, frames);
  };
  auto written = write_results(staging, files, go_on, what, name_set(motion, outcome.summary.run));
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

}  // namespace kinemark::pipeline::internal
