// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/track_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/stages/motion/control/camera_task.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

namespace kinemark::pipeline {
namespace {

std::string list(const std::vector<std::string>& names) { return names.empty() ? "none" : join(names); }

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
  options.emplace_back("outliers", o.judge_samples ? "left out" : "kept");
  if (job.images.any()) options.emplace_back("images in the lowest level", describe_images(job.images));
  options.emplace_back("determined in fewer than 95 % of the frames",
                       o.error_bars ? list(result.undetermined_coordinates) : "not known without error bars");
  return options;
}

Result<report::IkRun> describe_run(const TrackJob& job, const internal::MotionInputs& inputs,
                                   const motion::TrackResult& result, const TorqueAccount& torques) {
  auto run = internal::begin_run(job, inputs);
  run.method = "direct marker control";
  std::ranges::move(describe_options(job, result), std::back_inserter(run.options));
  run.solve_s = result.solve_seconds;
  internal::add_fit(run, result.fit, result.motion.time);
  run.locked_coordinates.insert(run.locked_coordinates.end(), result.locked_coordinates.begin(),
                                result.locked_coordinates.end());
  const double offset_m = result.fit.mean_error_m.norm();
  internal::add_marker_gates(run, job, offset_m,
                             fmt::format("The mean of all marker errors is {:.1f} mm long.", 1e3 * offset_m),
                             result.fit.rms_error_m);
  internal::add_frames_gate(run, "flagged", result.flagged_frames, result.motion.frames(),
                            fmt::format("are flagged: goals out of reach, or a body that ran away ({} times "
                                        "started anew)",
                                        result.restarts));
  internal::add_left_out_gate(run, result.motion);
  if (auto s = internal::add_torque_account(run, torques); !s) return std::unexpected(s.error());
  return run;
}

/// Rank of all levels, frame by frame.
data::Table rank_table(const motion::TrackResult& result) {
  data::Table table;
  table.name = "Rank of the tasks";
  table.columns = {"rank", "smallest_singular_value"};
  for (std::int64_t f = 0; f < result.motion.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    table.time_s.push_back(result.motion.time.time_s(f));
    table.values.insert(table.values.end(),
                        {static_cast<double>(result.rank[i]), result.smallest_singular[i]});
  }
  return table;
}

/// Standard deviations of the torques, from inverse dynamics of the resulting motion. Where that is not
/// possible (closed loops, few frames) they are absent, with a warning.
void add_torque_deviations(const model::Model& model, const TrackJob& job, motion::TrackResult& result) {
  auto motion = result.motion;
  const auto dynamics = motion::inverse_dynamics(model, motion, {.threads = job.options.threads});
  if (dynamics)
    result.motion.tau_sd = std::move(motion.tau_sd);
  else
    result.fit.warnings.push_back("standard deviations of torques are not known: " +
                                  dynamics.error().message);
}

/// The images join the lowest level.
Status add_images(const internal::MotionInputs& inputs, motion::TrackOptions& options) {
  if (!inputs.images) return {};
  const auto tasks = motion::camera_tasks(inputs.model, *inputs.images,
                                          {.cutoff_hz = options.cutoff_hz, .fade_s = options.fade_s});
  if (!tasks) return std::unexpected(tasks.error());
  if (options.levels.empty()) options.levels.push_back({.markers = {"*"}, .tasks = {}});
  auto& lowest = options.levels.back().tasks;
  lowest.insert(lowest.end(), tasks->begin(), tasks->end());
  return {};
}

/// What the controller pushes with knows nothing of the ground: with forces the torques are made anew, from
/// the motion and the forces.
Result<TorqueAccount> add_torques(const TrackJob& job, const internal::MotionInputs& inputs,
                                  motion::TrackResult& result) {
  const model::Model& model = inputs.model;
  if (!job.forces.empty())
    return pipeline::add_torques(model, result.motion, job.forces,
                                 {.error_bars = job.options.error_bars, .threads = job.options.threads},
                                 nullptr, inputs.axes);
  if (job.options.error_bars) add_torque_deviations(model, job, result);
  return TorqueAccount{};
}

/// The markers of the page, where each frame of the motion is one of the recording.
std::optional<data::Trajectories> markers_of(const data::Trajectories& recorded,
                                             const motion::TrackResult& result) {
  const auto& motion = result.motion;
  const auto last = result.fit.first_frame + motion.frames();
  if (motion.time.rate_hz != recorded.time.rate_hz || last > recorded.frames()) return std::nullopt;
  return internal::solved_markers(recorded, result.fit, motion);
}

Result<Staging> stage_files(const TrackJob& job) {
  std::vector<std::string> files{"_tau.sto", "_rank.sto", "_marker_errors.sto"};
  if (job.options.error_bars) files.insert(files.end(), {"_sd.sto", "_bound.sto", "_tau_sd.sto"});
  files.push_back("_report.json");
  std::vector<std::filesystem::path> further;
  if (!job.report.empty()) further.push_back(job.report);
  return internal::stage(job, files, further);
}

}  // namespace

Result<TrackOutcome> run_track(TrackJob job) {
  // Prepare: options, model and markers, where results go.
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  internal::take_recording_options(job, job.options);
  if (auto s = internal::check_named(job); !s) return std::unexpected(s.error());
  if (auto s = internal::check_output_named(job); !s) return std::unexpected(s.error());
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  if (auto s = job.options.check(); !s) return std::unexpected(s.error());
  const auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  auto staging = stage_files(job);
  if (!staging) return std::unexpected(staging.error());
  auto options = job.options;
  if (auto s = add_images(*inputs, options); !s) return std::unexpected(s.error());
  // Solve.
  auto result = motion::track_markers(inputs->model, inputs->trial.markers, options, job.progress);
  if (!result) {
    if (result.error().code == Code::usage) return std::unexpected(result.error());
    return fail_at(job.markers.string(), result.error());
  }
  TrackOutcome outcome;
  outcome.result = std::move(*result);
  const auto torques = add_torques(job, *inputs, outcome.result);
  if (!torques) return std::unexpected(torques.error());
  // Judge.
  auto run = describe_run(job, *inputs, outcome.result, *torques);
  if (!run) return std::unexpected(run.error());
  const auto& motion = outcome.result.motion;
  const auto solved = markers_of(inputs->trial.markers, outcome.result);
  if (auto s = internal::judge(std::move(*run), motion, nullptr, outcome); !s)
    return std::unexpected(s.error());
  // Write.
  auto files = internal::motion_files(job, motion, outcome.summary);
  files.push_back(table_file(beside(job.output, "_rank.sto"), [&] { return rank_table(outcome.result); }));
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] {
      return internal::motion_page(job, inputs->model, outcome.summary, motion, solved ? &*solved : nullptr,
                                   inputs->trial);
    }));
  if (auto s = internal::write(job, *staging, files, "direct marker control", motion, outcome); !s)
    return std::unexpected(s.error());
  return outcome;
}

}  // namespace kinemark::pipeline
