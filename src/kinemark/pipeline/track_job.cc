// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/track_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/file_hash.h"
#include "kinemark/pipeline/ik_job.h"
#include "kinemark/pipeline/motion_tables.h"
#include "kinemark/pipeline/staging.h"
#include "kinemark/pipeline/version.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

report::Gate make_gate(std::string name, double value, double bound, std::string unit, std::string sentence) {
  return {.name = std::move(name),
          .passed = value <= bound,
          .value = value,
          .bound = bound,
          .unit = std::move(unit),
          .sentence = std::move(sentence)};
}

std::vector<report::Gate> check_gates(const motion::TrackResult& result, const TrackJob& job) {
  const double offset = 1e3 * result.mean_marker_error_m.norm(), rms = 1e3 * result.rms_marker_error_m;
  const auto flagged = static_cast<double>(result.flagged_frames);
  return {
      make_gate("mean_marker_offset", offset, 1e3 * job.max_offset_m, "mm",
                fmt::format("The mean of all marker errors is {:.1f} mm long.", offset)),
      make_gate("marker_rms", rms, 1e3 * job.max_rms_m, "mm",
                fmt::format("The RMS distance between measured and model markers is {:.1f} mm; at most "
                            "{:.1f} mm is accepted.",
                            rms, 1e3 * job.max_rms_m)),
      make_gate("flagged", flagged, 0.0, "frames",
                fmt::format("{} of {} frames are flagged: goals out of reach, or a body that ran away ({} "
                            "times started anew).",
                            result.flagged_frames, result.motion.frames(), result.restarts))};
}

std::vector<std::pair<std::string, std::string>> describe_options(const TrackJob& job,
                                                                  const motion::TrackResult& result) {
  const auto& o = job.options;
  std::vector<std::pair<std::string, std::string>> options{
      {"levels of priority", std::to_string(std::max<std::size_t>(1, o.levels.size()))}};
  for (std::size_t i = 0; i < o.levels.size(); ++i)
    options.emplace_back(fmt::format("level {}", i + 1), list(o.levels[i].markers));
  options.emplace_back("gains", o.kp > 0.0 ? fmt::format("kp {:g} 1/s^2, kd {:g} 1/s", o.kp, o.kd)
                                           : fmt::format("omega {:g} rad/s", o.omega_rad_s));
  options.emplace_back("step", fmt::format("{:.4g} ms", 1e3 * result.step_s));
  options.emplace_back("damping", fmt::format("{:g}", o.damping));
  options.emplace_back("cut-off of the goals",
                       o.cutoff_hz > 0.0 ? fmt::format("{:g} Hz", o.cutoff_hz) : "none");
  options.emplace_back("feed-forward", o.feed_forward ? "on" : "off");
  options.emplace_back("posture", fmt::format("kp {:g} 1/s^2, kd {:g} 1/s", o.posture_kp, o.posture_kd));
  options.emplace_back("limits of clamped coordinates", o.limits ? "kept" : "ignored");
  options.emplace_back("not determined in 95 % of the frames", list(result.undetermined_coordinates));
  return options;
}

Status add_input(report::IkRun& run, const char* role, const fs::path& path) {
  const auto hash = hash_file(path);
  if (!hash) return std::unexpected(hash.error());
  run.inputs.push_back(
      {.role = role, .path = path.string(), .bytes = hash->bytes, .hash = hash->hex, .hash_kind = "XXH3-64"});
  return {};
}

report::IkRun describe_run(const TrackJob& job, const motion::TrackResult& result, const model::Model& model,
                           const data::Trial& trial) {
  report::IkRun run;
  run.trial = job.markers.filename().string();
  run.model = model.description().name;
  run.method = "direct marker control";
  run.version = kVersion;
  run.command_line = job.command_line;
  run.seed = job.options.seed;
  run.threads = job.options.threads;
  run.solve_s = result.solve_seconds;
  run.warnings = trial.warnings;
  const auto& of_model = model.description().warnings;
  run.warnings.insert(run.warnings.end(), of_model.begin(), of_model.end());
  run.warnings.insert(run.warnings.end(), result.warnings.begin(), result.warnings.end());
  run.options = describe_options(job, result);
  for (const auto& marker : result.markers)
    run.markers.push_back({.name = marker.name,
                           .weight = marker.weight,
                           .noise_sd_m = std::hypot(marker.noise_sd_m, marker.common_sd_m)});
  for (const auto& marker : result.excluded_markers)
    run.markers.push_back(
        {.name = marker.name,
         .weight = 0.0,
         .why_excluded = marker.seen ? "in no level, or given the weight 0" : "never seen"});
  for (const auto& name : result.model_markers_without_data)
    run.markers.push_back(
        {.name = name, .weight = 0.0, .why_excluded = "in the model, not in the recording"});
  for (const auto& name : result.data_markers_without_model)
    run.markers.push_back(
        {.name = name, .weight = 0.0, .why_excluded = "in the recording, not in the model"});
  for (const auto& coordinate : model.description().coordinates)
    if (coordinate.locked) run.locked_coordinates.push_back(coordinate.name);
  run.locked_coordinates.insert(run.locked_coordinates.end(), result.locked_coordinates.begin(),
                                result.locked_coordinates.end());
  run.gates = check_gates(result, job);
  for (const auto& gate : run.gates)
    if (!gate.passed) run.exit_status = 1;
  return run;
}

/// Generalised forces as they are, N m and N.
data::Table torques_table(const data::JointMotion& motion) {
  data::Table table;
  table.name = "Generalised forces in N m and N";
  for (std::int64_t f = 0; f < motion.frames(); ++f) table.time_s.push_back(motion.time.time_s(f));
  for (std::size_t c = 0; c < motion.coordinates.size(); ++c)
    table.columns.push_back(motion.coordinates[c] + (motion.is_rotation[c] ? "_moment" : "_force"));
  table.values = motion.tau;
  return table;
}

Status write_results(const TrackOutcome& outcome, const Staging& staging) {
  const auto& motion = outcome.result.motion;
  std::size_t next = 0;
  const auto put = [&](const data::Table& table) { return io::write_table(staging.path(next++), table, {}); };
  if (auto s = put(coordinates_table(motion)); !s) return s;
  if (auto s = put(torques_table(motion)); !s) return s;
  if (auto s = put(marker_errors_table(motion)); !s) return s;
  if (!motion.q_sd.empty()) {
    if (auto s = put(deviations_table(motion)); !s) return s;
    data::JointMotion bounds = motion;
    bounds.q_sd = motion.q_bound;
    auto table = deviations_table(bounds);
    table.name = "Bounds of coordinates";
    if (auto s = put(table); !s) return s;
  }
  return io::write_text(staging.path(next), report::summary_json(outcome.summary).dump(2) + "\n", false);
}

}  // namespace

Result<TrackOutcome> run_track(const TrackJob& job, const Progress& progress) {
  if (job.model.empty()) return fail(Code::usage, "no model; give --model");
  if (job.markers.empty()) return fail(Code::usage, "no marker file; give --markers");
  if (job.output.empty()) return fail(Code::usage, "no output; give --output");
  if (auto s = job.options.check(); !s) return std::unexpected(s.error());
  auto description = io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  const auto trial = io::read_markers(job.markers, {.rate_hz = job.rate_hz});
  if (!trial) return std::unexpected(trial.error());
  const auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(job.model.string(), model.error());

  std::vector<fs::path> targets{job.output, beside(job.output, "_tau.sto"),
                                beside(job.output, "_marker_errors.sto")};
  if (job.options.error_bars) {
    targets.push_back(beside(job.output, "_sd.sto"));
    targets.push_back(beside(job.output, "_bound.sto"));
  }
  targets.push_back(beside(job.output, "_report.json"));
  auto staging = Staging::create(targets, job.force);
  if (!staging) return std::unexpected(staging.error());

  TrackOutcome outcome;
  auto result = motion::track_markers(*model, trial->markers, job.options, progress);
  if (!result) {
    if (result.error().code == Code::usage) return std::unexpected(result.error());
    return fail_at(job.markers.string(), result.error());
  }
  outcome.result = std::move(*result);
  report::IkRun run = describe_run(job, outcome.result, *model, *trial);
  for (const auto& [role, path] : {std::pair{"model", job.model}, {"markers", job.markers}})
    if (auto s = add_input(run, role, path); !s) return std::unexpected(s.error());
  outcome.exit_status = run.exit_status;
  auto summary = report::summarize(std::move(run), outcome.result.motion, nullptr);
  if (!summary) return std::unexpected(summary.error());
  outcome.summary = std::move(*summary);
  if (auto s = write_results(outcome, *staging); !s) return staging->failure(s.error());
  const auto frames = outcome.result.motion.frames();
  if (progress && !progress(frames, frames))
    return fail(Code::cancelled, "direct marker control was stopped");
  if (auto s = staging->commit(); !s) return std::unexpected(s.error());
  outcome.written = std::move(targets);
  return outcome;
}

}  // namespace kinemark::pipeline
