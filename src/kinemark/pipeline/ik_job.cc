// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/ik_job.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/file_hash.h"
#include "kinemark/pipeline/ik_estimate.h"
#include "kinemark/pipeline/ik_setup_options.h"
#include "kinemark/pipeline/motion_tables.h"
#include "kinemark/pipeline/staging.h"
#include "kinemark/pipeline/version.h"
#include "kinemark/stages/report/ik_report.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

report::Gate make_gate(std::string name, double value, double bound, std::string unit, std::string sentence) {
  return {.name = std::move(name),
          .passed = value <= bound,
          .value = value,
          .bound = bound,
          .unit = std::move(unit),
          .sentence = std::move(sentence)};
}

/// How the recording lies to the model when they do not meet, in one sentence.
std::string offset_sentence(const motion::IkResult& result, const IkJob& job, const model::Model& model,
                            const data::Trajectories& markers) {
  const auto& mean = result.mean_marker_error_m;
  if (mean.norm() <= job.max_offset_m)
    return fmt::format("The mean of all marker errors is {:.1f} mm long.", 1e3 * mean.norm());
  const auto offset = motion::find_common_offset(model, markers, job.options);
  const Eigen::Vector3d shift = offset ? offset->shift_m : Eigen::Vector3d(-mean);
  return fmt::format(
      "The measured markers lie {:.3f} m away from the model: shifted by ({:+.3f}, {:+.3f}, {:+.3f}) m they "
      "would fit with "
      "{:.1f} mm RMS instead of {:.1f} mm. Check that recording and model share origin, axes and unit.",
      shift.norm(), shift.x(), shift.y(), shift.z(), 1e3 * (offset ? offset->rms_after_m : 0.0),
      1e3 * result.rms_marker_error_m);
}

std::vector<report::Gate> check_gates(const motion::IkResult& result, const IkJob& job,
                                      const model::Model& model, const data::Trajectories& markers) {
  std::vector<report::Gate> gates;
  gates.push_back(make_gate("mean_marker_offset", 1e3 * result.mean_marker_error_m.norm(),
                            1e3 * job.max_offset_m, "mm", offset_sentence(result, job, model, markers)));
  gates.push_back(make_gate(
      "marker_rms", 1e3 * result.rms_marker_error_m, 1e3 * job.max_rms_m, "mm",
      fmt::format(
          "The RMS distance between measured and model markers is {:.1f} mm; at most {:.1f} mm is accepted.",
          1e3 * result.rms_marker_error_m, 1e3 * job.max_rms_m)));
  std::int64_t failed = 0;
  for (const auto status : result.motion.status) failed += status == data::FrameStatus::not_converged;
  gates.push_back(
      make_gate("not_converged", static_cast<double>(failed), 0.0, "frames",
                fmt::format("{} of {} frames did not converge.", failed, result.motion.frames())));
  if (!std::isnan(result.max_loop_gap_m) && result.max_loop_gap_m > 0.0)
    gates.push_back(
        make_gate("loop_gap", 1e3 * result.max_loop_gap_m, 1e-3, "mm",
                  fmt::format("The widest gap of a closed loop is {:.2g} mm; at most 0.001 mm is accepted.",
                              1e3 * result.max_loop_gap_m)));
  return gates;
}

Status add_input(report::IkRun& run, const char* role, const fs::path& path) {
  if (path.empty()) return {};
  const auto hash = hash_file(path);
  if (!hash) return std::unexpected(hash.error());
  run.inputs.push_back(
      {.role = role, .path = path.string(), .bytes = hash->bytes, .hash = hash->hex, .hash_kind = "XXH3-64"});
  return {};
}

report::IkRun describe_run(const IkJob& job, const motion::IkResult& result, const model::Model& model,
                           const data::Trial& trial) {
  report::IkRun run;
  run.trial = job.markers.filename().string();
  run.model = model.description().name;
  run.method = job.estimator == Estimator::smoother ? "whole-trajectory smoother" : "least squares";
  run.version = kVersion;
  run.command_line = job.command_line;
  run.seed = job.options.seed;
  run.threads = job.options.threads;
  run.solve_s = result.solve_seconds;
  run.warnings = trial.warnings;
  const auto& of_model = model.description().warnings;
  run.warnings.insert(run.warnings.end(), of_model.begin(), of_model.end());
  run.warnings.insert(run.warnings.end(), result.warnings.begin(), result.warnings.end());
  const auto& o = job.options;
  const char* losses[] = {"square", "huber", "cauchy"};
  run.options = {
      {"loss", losses[static_cast<int>(o.loss)]},
      {"loss scale", fmt::format("{} m", o.loss_scale_m)},
      {"limits of clamped coordinates", o.limits ? "kept" : "ignored"},
      {"marker noise", o.marker_noise_sd_m > 0.0 ? fmt::format("{} m per axis, given", o.marker_noise_sd_m)
                                                 : "estimated from the residuals, per marker and segment"},
      {"coordinate tasks", std::to_string(o.coordinate_tasks.size())},
      {"starts of the first frame", std::to_string(o.starts)}};
  for (const auto& marker : result.markers)
    run.markers.push_back({.name = marker.name,
                           .weight = marker.weight,
                           .noise_sd_m = std::hypot(marker.noise_sd_m, marker.common_sd_m)});
  for (const auto& marker : result.excluded_markers)
    run.markers.push_back({.name = marker.name,
                           .weight = 0.0,
                           .why_excluded = marker.seen ? "given the weight 0" : "never seen"});
  for (const auto& name : result.model_markers_without_data)
    run.markers.push_back(
        {.name = name, .weight = 0.0, .why_excluded = "in the model, not in the recording"});
  for (const auto& name : result.data_markers_without_model)
    run.markers.push_back(
        {.name = name, .weight = 0.0, .why_excluded = "in the recording, not in the model"});
  for (const auto& coordinate : model.description().coordinates)
    if (coordinate.locked) run.locked_coordinates.push_back(coordinate.name);
  run.gates = check_gates(result, job, model, trial.markers);
  for (const auto& gate : run.gates)
    if (!gate.passed) run.exit_status = 1;
  return run;
}

/// The used markers on the frames that were solved, under the model's names.
data::Trajectories solved_markers(const data::Trajectories& recorded, const motion::IkResult& result) {
  std::vector<std::string> names;
  for (const auto& marker : result.markers) names.push_back(marker.name);
  auto solved = data::Trajectories::all_missing(names, result.motion.time);
  for (std::size_t m = 0; m < result.markers.size(); ++m) {
    const auto from = recorded.find(result.markers[m].name_in_data);
    for (std::int64_t f = 0; f < solved.frames(); ++f) {
      const auto to = static_cast<std::int64_t>(m);
      solved.x(f, to) = recorded.x(result.first_frame + f, from);
      solved.state[solved.index(f, to)] = recorded.state[recorded.index(result.first_frame + f, from)];
    }
  }
  return solved;
}

Status write_results(const IkJob& job, const IkOutcome& outcome, const data::Trajectories& markers,
                     const Staging& staging) {
  const auto& motion = outcome.result.motion;
  const io::TableWriteOptions table_options;
  if (auto s = io::write_table(staging.path(0), coordinates_table(motion), table_options); !s) return s;
  if (!motion.q_sd.empty())
    if (auto s = io::write_table(staging.path(1), deviations_table(motion), table_options); !s) return s;
  if (auto s = io::write_table(staging.path(2), marker_errors_table(motion), table_options); !s) return s;
  if (auto s = io::write_text(staging.path(3), report::summary_json(outcome.summary).dump(2) + "\n", false);
      !s)
    return s;
  if (!job.report.empty()) {
    const std::string page =
        report::report_html({.summary = outcome.summary, .motion = &motion, .markers = &markers});
    if (auto s = io::write_text(staging.path(4), page, false); !s) return s;
  }
  const std::size_t torque = job.report.empty() ? 4 : 5;
  if (!motion.tau.empty())
    if (auto s = io::write_table(staging.path(torque), torques_table(motion), table_options); !s) return s;
  if (!motion.tau_sd.empty())
    if (auto s = io::write_table(staging.path(torque + 1), torque_deviations_table(motion), table_options);
        !s)
      return s;
  return {};
}

}  // namespace

fs::path beside(const fs::path& output, const std::string& suffix) {
  return output.parent_path() / (output.stem().string() + suffix);
}

Result<IkOutcome> run_ik(IkJob job, const Progress& progress) {
  if (auto s = apply_setup(job); !s) return std::unexpected(s.error());
  if (job.model.empty()) return fail(Code::usage, "no model; give --model or a --setup that names one");
  if (job.markers.empty())
    return fail(Code::usage, "no marker file; give --markers or a --setup that names one");
  if (job.output.empty()) return fail(Code::usage, "no output; give --output or a --setup that names one");

  auto description = io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  if (description->markers.empty())
    return fail(Code::bad_input, fmt::format("{}: model '{}' has no markers; need at least one",
                                             job.model.string(), description->name));
  const auto trial = io::read_markers(job.markers, {.rate_hz = job.rate_hz});
  if (!trial) return std::unexpected(trial.error());
  const auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(job.model.string(), model.error());
  if (auto s = apply_tasks(job, *model, trial->markers); !s) return std::unexpected(s.error());

  std::vector<fs::path> targets{job.output, beside(job.output, "_sd.sto"),
                                beside(job.output, "_marker_errors.sto"), beside(job.output, "_report.json")};
  if (!job.report.empty()) targets.push_back(job.report);
  if (job.torques) targets.push_back(beside(job.output, "_tau.sto"));
  if (job.torques && job.options.error_bars) targets.push_back(beside(job.output, "_tau_sd.sto"));
  auto staging = Staging::create(targets, job.force);
  if (!staging) return std::unexpected(staging.error());

  IkOutcome outcome;
  auto result = estimate_motion(job, *model, trial->markers, progress);
  if (!result) return fail_at(job.markers.string(), result.error());
  outcome.result = std::move(*result);

  report::IkRun run = describe_run(job, outcome.result, *model, *trial);
  for (const auto& [role, path] :
       {std::pair{"model", job.model}, {"markers", job.markers}, {"setup", job.setup}, {"tasks", job.tasks}})
    if (auto s = add_input(run, role, path); !s) return std::unexpected(s.error());
  outcome.exit_status = run.exit_status;
  const data::Trajectories solved = solved_markers(trial->markers, outcome.result);
  auto summary = report::summarize(std::move(run), outcome.result.motion, &solved);
  if (!summary) return std::unexpected(summary.error());
  outcome.summary = std::move(*summary);
  if (auto s = write_results(job, outcome, solved, *staging); !s) return staging->failure(s.error());
  const auto frames = outcome.result.motion.frames();
  if (progress && !progress(frames, frames)) return fail(Code::cancelled, "inverse kinematics was stopped");
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  for (const auto& target : targets)
    if (fs::exists(target)) outcome.written.push_back(target);
  return outcome;
}

}  // namespace kinemark::pipeline
