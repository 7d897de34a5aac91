// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/ik_estimate.h"
#include "kinemark/pipeline/motion/ik_setup_options.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/motion/marker_locations.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// One sentence on the offset between recording and model when they do not coincide.
std::string offset_sentence(const motion::IkResult& result, const IkJob& job, const model::Model& model,
                            const data::Trajectories& markers) {
  const auto& mean = result.fit.mean_error_m;
  if (!mean.allFinite()) return {};  // no marker is seen, which the gate says
  if (mean.norm() <= job.max_offset_m)
    return fmt::format("The mean of all marker errors is {:.1f} mm long.", 1e3 * mean.norm());
  const auto offset = motion::find_common_offset(model, markers, job.options);
  if (!offset)
    return fmt::format(
        "The mean of all marker errors is {:.1f} mm long. Check that recording and model share origin, axes "
        "and "
        "unit.",
        1e3 * mean.norm());
  const auto& shift = offset->shift_m;
  return fmt::format(
      "The measured markers lie {:.3f} m away from the model: shifted by ({:+.3f}, {:+.3f}, {:+.3f}) m they "
      "would fit with "
      "{:.1f} mm RMS instead of {:.1f} mm. Check that recording and model share origin, axes and unit.",
      shift.norm(), shift.x(), shift.y(), shift.z(), 1e3 * offset->rms_after_m, 1e3 * result.fit.rms_error_m);
}

constexpr const char* kOrSetup = " or a --setup that names one";
constexpr double kMostFramesOff = 5.0;  // %: frames that fit worse than a recording may as a whole

/// Gates of single frames and samples, which the RMS of a whole recording hides.
void add_frame_gates(report::IkRun& run, const IkJob& job, const data::JointMotion& motion) {
  const auto M = motion.markers.size();
  std::int64_t off = 0, seen = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    double squares = 0.0;
    int count = 0;
    for (std::size_t m = 0; m < M; ++m) {
      const double* error = motion.marker_error.data() + 3 * (static_cast<std::size_t>(f) * M + m);
      if (std::isnan(error[0])) continue;
      squares += error[0] * error[0] + error[1] * error[1] + error[2] * error[2];
      ++count;
    }
    off += squares > count * job.max_rms_m * job.max_rms_m;
    seen += count > 0;
  }
  const auto percent = [](std::int64_t part, std::int64_t all) {
    return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
  };
  internal::add_gate(
      run, "frames_off", percent(off, seen), kMostFramesOff, "%",
      fmt::format("In {} of {} frames the RMS distance between measured and model markers is above "
                  "{:.1f} mm; at most {:g} % are accepted.",
                  off, seen, 1e3 * job.max_rms_m, kMostFramesOff));
  internal::add_left_out_gate(run, motion);
}

void add_gates(report::IkRun& run, const IkJob& job, const internal::MotionInputs& inputs,
               const motion::IkResult& result) {
  internal::add_marker_gates(run, job, result.fit.mean_error_m.norm(),
                             offset_sentence(result, job, inputs.model, inputs.trial.markers),
                             result.fit.rms_error_m);
  std::int64_t failed = 0;
  for (const auto status : result.motion.status) failed += status == data::FrameStatus::not_converged;
  internal::add_frames_gate(run, "not_converged", failed, result.motion.frames(), "did not converge");
  add_frame_gates(run, job, result.motion);
  if (!std::isnan(result.fit.max_loop_gap_m) && result.fit.max_loop_gap_m > 0.0)
    internal::add_gate(
        run, "loop_gap", 1e3 * result.fit.max_loop_gap_m, 1e-3, "mm",
        fmt::format("The widest gap of a closed loop is {:.2g} mm; at most 0.001 mm is accepted.",
                    1e3 * result.fit.max_loop_gap_m));
}

Result<report::IkRun> describe_run(const IkJob& job, const internal::MotionInputs& inputs,
                                   const motion::IkResult& result, const TorqueAccount& torques) {
  auto run = internal::begin_run(job, inputs);
  if (auto s = internal::add_input(run, "setup", job.setup); !s) return std::unexpected(s.error());
  for (const auto& part : job.setup_parts)
    if (auto s = internal::add_input(run, "setup part", part); !s) return std::unexpected(s.error());
  if (auto s = internal::add_input(run, "tasks", job.tasks); !s) return std::unexpected(s.error());
  const auto& o = job.options;
  const char* losses[] = {"square", "huber", "cauchy"};
  run.method = job.estimator == Estimator::smoother ? "whole-trajectory smoother" : "least squares";
  run.options.insert(
      run.options.end(),
      {{"loss", losses[static_cast<int>(o.loss)]},
       {"loss scale", fmt::format("{} m", o.loss_scale_m)},
       {"limits of clamped coordinates", o.limits ? "kept" : "ignored"},
       {"marker noise", o.marker_noise_sd_m > 0.0 ? fmt::format("{} m per axis, given", o.marker_noise_sd_m)
                                                  : "estimated from the residuals, per marker and segment"},
       {"outliers", o.judge_samples ? "left out" : "kept"},
       {"coordinate tasks", std::to_string(o.coordinate_tasks.size())},
       {"starts of the first frame", std::to_string(o.starts)}});
  if (job.images.any()) run.options.emplace_back("images in place of markers", describe_images(job.images));
  run.solve_s = result.solve_seconds;
  internal::add_fit(run, result.fit, result.motion.time);
  add_gates(run, job, inputs, result);
  if (auto s = internal::add_torque_account(run, torques); !s) return std::unexpected(s.error());
  return run;
}

/// Fill in what a setup names and what options follow from others, and check that it is enough.
Status complete(IkJob& job) {
  internal::take_recording_options(job, job.options);
  if (auto s = apply_setup(job); !s) return s;
  if (auto s = internal::check_named(job, kOrSetup); !s) return s;
  if (job.images.any() && job.estimator != Estimator::smoother)
    return fail(Code::usage, "least squares cannot use images; give --estimator smoother");
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  job.torques = job.torques || !job.forces.empty();
  return {};
}

Result<Staging> stage_files(const IkJob& job) {
  std::vector<fs::path> further;
  if (!job.report.empty()) further.push_back(job.report);
  if (job.marker_locations) further.push_back(beside(job.output, "_marker_locations.sto"));
  if (job.torques) further.push_back(beside(job.output, "_tau.sto"));
  if (job.torques && job.options.error_bars) further.push_back(beside(job.output, "_tau_sd.sto"));
  std::vector<fs::path> read{job.setup, job.tasks, job.coordinates};
  read.insert(read.end(), job.setup_parts.begin(), job.setup_parts.end());
  return internal::stage(job, {"_sd.sto", "_marker_errors.sto", "_report.json"}, further, read);
}

/// A solution that was judged, and the markers that it is of.
struct Solved {
  IkOutcome outcome;
  data::Trajectories markers;  ///< that were used, without what was left out
};

Result<Solved> solve(const IkJob& job, const internal::MotionInputs& inputs) {
  auto estimate = estimate_motion(job, inputs.model, inputs.trial.markers,
                                  inputs.images ? &*inputs.images : nullptr, inputs.axes);
  if (!estimate) return std::unexpected(estimate.error());
  Solved solved;
  auto& result = solved.outcome.result = std::move(estimate->ik);
  solved.markers = internal::solved_markers(inputs.trial.markers, result.fit, result.motion);
  auto run = describe_run(job, inputs, result, estimate->torques);
  if (!run) return std::unexpected(run.error());
  run->warnings.insert(run->warnings.begin(), job.setup_notes.begin(), job.setup_notes.end());
  if (auto s = internal::judge(std::move(*run), result.motion, &solved.markers, solved.outcome); !s)
    return std::unexpected(s.error());
  return solved;
}

}  // namespace

Result<IkOutcome> run_ik(IkJob job) {
  // Prepare: options, model and markers, tasks, where results go.
  if (auto s = complete(job); !s) return std::unexpected(s.error());
  if (auto s = internal::check_output_named(job, kOrSetup); !s) return std::unexpected(s.error());
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  const auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  const auto& model = inputs->model;
  if (auto s = apply_tasks(job, model, inputs->trial.markers); !s) return std::unexpected(s.error());
  auto staging = stage_files(job);
  if (!staging) return std::unexpected(staging.error());
  // Solve and judge.
  auto solved = solve(job, *inputs);
  if (!solved) return std::unexpected(solved.error());
  auto& outcome = solved->outcome;
  const auto& motion = outcome.result.motion;
  // Write.
  auto files = internal::motion_files(job, motion, outcome.summary);
  if (job.marker_locations)
    files.push_back(table_file(beside(job.output, "_marker_locations.sto"),
                               [&model, &motion] { return marker_locations_table(model, motion); }));
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] {
      return internal::motion_page(job, model, outcome.summary, motion, &solved->markers, inputs->trial);
    }));
  if (auto s = internal::write(job, *staging, files, "inverse kinematics", motion, outcome); !s)
    return std::unexpected(s.error());
  return std::move(outcome);
}

Result<IkPage> ik_page(IkJob job, std::int64_t most_samples) {
  if (auto s = complete(job); !s) return std::unexpected(s.error());
  const auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  const auto& markers = inputs->trial.markers;
  if (markers.frames() * markers.markers() > most_samples)
    return fail(
        Code::not_supported,
        fmt::format("{}: {} frames of {} markers are more than is solved here; take 'kinemark ik', or "
                    "crop the recording",
                    job.markers.filename().string(), markers.frames(), markers.markers()));
  if (auto s = apply_tasks(job, inputs->model, markers); !s) return std::unexpected(s.error());
  const auto solved = solve(job, *inputs);
  if (!solved) return std::unexpected(solved.error());
  const auto& [outcome, used] = *solved;
  const auto& motion = outcome.result.motion;
  if (job.progress && !job.progress(motion.frames(), motion.frames()))
    return fail(Code::cancelled, "inverse kinematics was stopped");
  return IkPage{
      .html = internal::motion_page(job, inputs->model, outcome.summary, motion, &used, inputs->trial),
      .summary = outcome.summary,
      .set = internal::name_set(motion, outcome.summary.run),
      .edits = inputs->edits.in_force,
      .digest = inputs->journal.file ? inputs->journal.digest : io::digest_of({})};
}

}  // namespace kinemark::pipeline
