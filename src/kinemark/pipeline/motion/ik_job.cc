// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/motion/ik_setup_options.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/motion/internal/sensor_run.h"
#include "kinemark/pipeline/motion/marker_locations.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOrSetup = " or a --setup that names one";
constexpr const char* kOrientationErrors = "_orientation_errors.sto";

Result<report::IkRun> describe_run(const IkJob& job, const internal::MotionInputs& inputs,
                                   const workflow::IkFound& found) {
  auto run = internal::begin_run(job, inputs);
  if (auto s = internal::add_input(run, "setup", job.setup); !s) return std::unexpected(s.error());
  for (const auto& part : job.setup_parts)
    if (auto s = internal::add_input(run, "setup part", part); !s) return std::unexpected(s.error());
  if (auto s = internal::add_input(run, "tasks", job.tasks); !s) return std::unexpected(s.error());
  const auto& o = job.options;
  const char* losses[] = {"square", "huber", "cauchy"};
  run.method = job.estimator == workflow::Estimator::smoother ? "whole-trajectory smoother" : "least squares";
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
  if (found.sensors)
    std::ranges::move(internal::sensor_facts(found.sensors->fit, job.sensors),
                      std::back_inserter(run.options));
  run.solve_s = found.result.solve_seconds;
  internal::add_found(run, found.result.fit, found.torques, found.remarks);
  return run;
}

/// What orientations beside markers need.
Status check_sensors(IkJob& job) {
  const auto& sensors = job.sensors;
  if (sensors.orientations.empty()) return {};
  if (job.estimator != workflow::Estimator::least_squares)
    return fail(Code::usage, "the smoother cannot use orientations; give --estimator least-squares");
  if (sensors.options.facing && sensors.pose.empty())
    return fail(Code::usage, "--heading is for sensors that a pose places; give it, --calibration");
  job.sensors.options.judge_samples = job.drops_doubtful(job.sensors.options.judge_samples);
  return internal::check_up(job.sensors, "--sensors-up");
}

/// Fill in what a setup names and what options follow from others, and check that it is enough.
Status complete(IkJob& job) {
  internal::take_recording_options(job, job.options);
  if (auto s = apply_setup(job); !s) return s;
  if (auto s = internal::check_named(job, kOrSetup); !s) return s;
  if (job.images.any() && job.estimator != workflow::Estimator::smoother)
    return fail(Code::usage, "least squares cannot use images; give --estimator smoother");
  if (auto s = check_sensors(job); !s) return s;
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  job.torques = job.torques || !job.forces.empty();
  return {};
}

Result<Staging> stage_files(const IkJob& job) {
  std::vector<fs::path> further;
  if (!job.report.empty()) further.push_back(job.report);
  if (job.marker_locations) further.push_back(beside(job.output, "_marker_locations.sto"));
  if (!job.sensors.orientations.empty()) further.push_back(beside(job.output, kOrientationErrors));
  if (job.torques) further.push_back(beside(job.output, "_tau.sto"));
  if (job.torques && job.options.error_bars) further.push_back(beside(job.output, "_tau_sd.sto"));
  std::vector<fs::path> read{job.setup, job.tasks, job.coordinates, job.sensors.orientations,
                             job.sensors.pose};
  read.insert(read.end(), job.setup_parts.begin(), job.setup_parts.end());
  return internal::stage(job, {"_sd.sto", "_marker_errors.sto", "_report.json"}, further, read);
}

/// A solution that was judged, and the markers that it is of.
struct Solved {
  IkOutcome outcome;
  data::Trajectories markers;      ///< that were used, without what was left out
  Array<double> sensor_error_rad;  ///< F x S
};

/// Sensors beside the markers, where there are any; their files go into the record.
Status add_sensors(const IkJob& job, internal::MotionInputs& inputs,
                   std::optional<workflow::SensorInputs>& sensors) {
  if (job.sensors.orientations.empty()) return {};
  auto read = internal::read_sensors(job.sensors, job.model, inputs.model, inputs.files,
                                     inputs.recording.trial.warnings);
  if (!read) return std::unexpected(read.error());
  sensors = std::move(*read);
  return {};
}

Result<Solved> solve(const IkJob& job, internal::MotionInputs& inputs) {
  std::optional<workflow::SensorInputs> sensors;
  if (auto s = add_sensors(job, inputs, sensors); !s) return std::unexpected(s.error());
  auto found = workflow::ik(inputs.model, inputs.recording,
                            {.ik = job.options,
                             .estimator = job.estimator,
                             .torques = job.torques,
                             .bounds = job,
                             .images = inputs.image_tracks(),
                             .sensors = sensors ? &*sensors : nullptr,
                             .progress = job.progress});
  if (!found) return fail_at(job.markers.string(), found.error());
  if (found->sensors) {
    auto remarks = internal::sensor_remarks(found->sensors->fit, job.sensors, job.options.error_bars, true);
    std::ranges::move(remarks.warnings, std::back_inserter(found->remarks.warnings));
    std::ranges::move(remarks.gates, std::back_inserter(found->remarks.gates));
  }
  auto run = describe_run(job, inputs, *found);
  if (!run) return std::unexpected(run.error());
  Solved solved;
  solved.markers = std::move(found->used);
  if (found->sensors) {
    solved.outcome.sensor_fit = std::move(found->sensors->fit);
    solved.sensor_error_rad = std::move(found->sensors->error_rad);
  }
  auto& result = solved.outcome.result = std::move(found->result);
  run->warnings.insert(run->warnings.begin(), job.setup_notes.begin(), job.setup_notes.end());
  if (auto s = internal::judge(std::move(*run), result.motion, &solved.markers, solved.outcome); !s)
    return std::unexpected(s.error());
  return solved;
}

}  // namespace

Result<IkOutcome> run_ik(IkJob job) {
  // Prepare: options, where results go, model and markers, tasks.
  if (auto s = complete(job); !s) return std::unexpected(s.error());
  if (auto s = internal::check_output_named(job, kOrSetup); !s) return std::unexpected(s.error());
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return std::unexpected(s.error());
  auto staging = stage_files(job);
  if (!staging) return std::unexpected(staging.error());
  auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  const auto& model = inputs->model;
  if (auto s = apply_tasks(job, model, inputs->recording.trial.markers); !s)
    return std::unexpected(s.error());
  // Solve and judge.
  auto solved = solve(job, *inputs);
  if (!solved) return std::unexpected(solved.error());
  auto& outcome = solved->outcome;
  const auto& motion = outcome.result.motion;
  // Write.
  const auto& sensor_fit = outcome.sensor_fit;
  auto files = internal::motion_files(
      job, motion, outcome.summary,
      sensor_fit ? nlohmann::ordered_json{{"orientations", internal::sensors_json(*sensor_fit)}}
                 : nlohmann::ordered_json());
  if (sensor_fit)
    files.push_back(table_file(beside(job.output, kOrientationErrors), [&] {
      return internal::orientation_errors_table(motion.time, *sensor_fit, solved->sensor_error_rad);
    }));
  if (job.marker_locations)
    files.push_back(table_file(beside(job.output, "_marker_locations.sto"),
                               [&model, &motion] { return marker_locations_table(model, motion); }));
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] {
      std::optional<report::ReportSensors> sensors;
      if (sensor_fit) sensors = internal::page_sensors(motion.time, *sensor_fit, solved->sensor_error_rad);
      return internal::motion_page(job, model, outcome.summary, motion, &solved->markers,
                                   inputs->recording.trial, sensors ? &*sensors : nullptr);
    }));
  if (auto s = internal::write(job, *staging, files, "inverse kinematics", motion, outcome); !s)
    return std::unexpected(s.error());
  return std::move(outcome);
}

Result<IkPage> ik_page(IkJob job, std::int64_t most_samples) {
  if (auto s = complete(job); !s) return std::unexpected(s.error());
  auto inputs = internal::read_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  const auto& markers = inputs->recording.trial.markers;
  if (markers.frames() * markers.markers() > most_samples)
    return fail(
        Code::not_supported,
        fmt::format("{}: {} frames of {} markers are more than is solved here; take 'kinemark ik', or "
                    "crop the recording",
                    job.markers.filename().string(), markers.frames(), markers.markers()));
  if (auto s = apply_tasks(job, inputs->model, markers); !s) return std::unexpected(s.error());
  const auto solved = solve(job, *inputs);
  if (!solved) return std::unexpected(solved.error());
  const auto& outcome = solved->outcome;
  const auto& motion = outcome.result.motion;
  if (job.progress && !job.progress(motion.frames(), motion.frames()))
    return fail(Code::cancelled, "inverse kinematics was stopped");
  return IkPage{
      .html = internal::motion_page(job, inputs->model, outcome.summary, motion, &solved->markers,
                                    inputs->recording.trial),
      .summary = outcome.summary,
      .set = internal::name_set(motion, outcome.summary.run),
      .edits = inputs->recording.edits.in_force,
      .digest = inputs->recording.journal.file ? inputs->recording.journal.digest : io::digest_of({})};
}

}  // namespace kinemark::pipeline
