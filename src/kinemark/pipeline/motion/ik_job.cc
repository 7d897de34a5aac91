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
#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/io/place.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
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

/// Linear interpolation of a column at time t; the ends hold.
double at_time(const data::Table& table, std::int64_t column, double t) {
  const auto next = std::upper_bound(table.time_s.begin(), table.time_s.end(), t) - table.time_s.begin();
  if (next == 0) return table(0, column);
  if (next == table.rows()) return table(next - 1, column);
  const double t0 = table.time_s[static_cast<std::size_t>(next - 1)],
               t1 = table.time_s[static_cast<std::size_t>(next)];
  const double share = (t - t0) / (t1 - t0);
  return (1.0 - share) * table(next - 1, column) + share * table(next, column);
}

/// Task values from the coordinate file, one per solved frame.
Result<std::vector<double>> values_from_file(const data::Table& table, const data::ModelDescription& model,
                                             int coordinate_idx, const data::Trajectories& markers,
                                             const motion::IkOptions& options) {
  const auto& name = model.coordinates[static_cast<std::size_t>(coordinate_idx)].name;
  const auto column = table.find(name);
  if (column < 0)
    return fail(Code::bad_input, fmt::format("has no column '{}', which a task takes its values from", name));
  const double unit = column_unit(table, model, coordinate_idx);
  const double slack = motion::kTimeSlack / markers.time.rate_hz;
  std::vector<double> values;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double t = markers.time.time_s(f);
    if (t >= options.first_time_s - slack && t <= options.last_time_s + slack)
      values.push_back(unit * at_time(table, column, t));
  }
  return values;
}

bool has_weight(const motion::IkOptions& options, const std::string& marker) {
  return std::any_of(options.marker_weights.begin(), options.marker_weights.end(),
                     [&](const auto& w) { return w.marker == marker; });
}

bool has_task(const motion::IkOptions& options, const std::string& coordinate) {
  return std::any_of(options.coordinate_tasks.begin(), options.coordinate_tasks.end(),
                     [&](const auto& t) { return t.coordinate == coordinate; });
}

Status add_tasks(const io::IkTasks& tasks, const std::filesystem::path& file,
                 const std::filesystem::path& coordinate_file, const model::Model& model,
                 const data::Trajectories& markers, motion::IkOptions& options) {
  // Only listed markers take part, as in OpenSim; a marker that model or recording lacks is not an error
  // there either.
  options.default_marker_weight = 0.0;
  for (const auto& task : tasks.markers) {
    if (has_weight(options, task.name) ||
        (model.description().find_marker(task.name) < 0 && markers.find(task.name) < 0))
      continue;
    options.marker_weights.push_back({task.name, task.apply ? task.weight : 0.0});
  }
  std::optional<data::Table> table;
  for (const auto& task : tasks.coordinates) {
    if (!task.apply || task.weight == 0.0 || has_task(options, task.name)) continue;
    const int c = model.description().find_coordinate(task.name);
    if (c < 0)
      return fail(Code::bad_input,
                  fmt::format("{}: a task names coordinate '{}', which the model does not have",
                              file.string(), task.name));
    const auto& coordinate = model.description().coordinates[static_cast<std::size_t>(c)];
    motion::CoordinateTask goal{
        .coordinate = task.name, .weight = task.weight, .value = coordinate.default_value};
    if (task.target == io::IkCoordinateTask::Target::manual_value) goal.value = task.value;
    if (task.target == io::IkCoordinateTask::Target::from_file) {
      if (!table) {
        auto read = io::read_table(coordinate_file);
        if (!read) return std::unexpected(read.error());
        table = std::move(*read);
      }
      auto values = values_from_file(*table, model.description(), c, markers, options);
      if (!values) return fail_at(coordinate_file.string(), values.error());
      goal.values = std::move(*values);
    }
    options.coordinate_tasks.push_back(std::move(goal));
  }
  return {};
}

/// OpenSim takes the frames nearest to both ends of a setup's range, also where they lie outside it.
void take_nearest_frames(const io::IkSetup& setup, const data::Trajectories& markers,
                         motion::IkOptions& options) {
  const auto nearest = [&](double t) {
    const double frame = std::round((t - markers.time.t0_s) * markers.time.rate_hz);
    const bool recorded = frame >= 0.0 && frame < static_cast<double>(markers.frames());
    return recorded ? markers.time.time_s(static_cast<std::int64_t>(frame)) : t;
  };
  // A range that options changed is taken as it was given.
  if (std::isfinite(setup.time_begin_s) && options.first_time_s == setup.time_begin_s)
    options.first_time_s = std::min(options.first_time_s, nearest(setup.time_begin_s));
  if (std::isfinite(setup.time_end_s) && options.last_time_s == setup.time_end_s)
    options.last_time_s = std::max(options.last_time_s, nearest(setup.time_end_s));
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
  internal::add_nwb_file(job, motion, outcome.summary, inputs->recording.trial.beside, files);
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

Status apply_setup(IkJob& job) {
  if (job.setup.empty()) return {};
  const auto setup = io::read_ik_setup(job.setup);
  if (!setup) return std::unexpected(setup.error());
  if (job.model.empty()) job.model = setup->model_file;
  if (job.markers.empty()) job.markers = setup->marker_file;
  job.coordinates = setup->coordinate_file;
  job.setup_notes = setup->notes;
  job.setup_parts = setup->parts;
  job.marker_locations = job.marker_locations || setup->report_marker_locations;
  if (job.output.empty() && !setup->output_motion_file.empty()) {
    if (auto s = io::check_below(job.setup, setup->output_motion_file, "output_motion_file"); !s) return s;
    job.output = setup->output_motion_file;
  }
  if (job.options.first_time_s < -1e299) job.options.first_time_s = std::max(-1e300, setup->time_begin_s);
  if (job.options.last_time_s > 1e299) job.options.last_time_s = std::min(1e300, setup->time_end_s);
  return {};
}

Status apply_tasks(IkJob& job, const model::Model& model, const data::Trajectories& markers) {
  io::IkSetup setup;
  if (!job.setup.empty()) {
    auto read = io::read_ik_setup(job.setup);
    if (!read) return std::unexpected(read.error());
    setup = std::move(*read);
    take_nearest_frames(setup, markers, job.options);
  }
  if (!job.tasks.empty()) {
    const auto tasks = io::read_ik_tasks(job.tasks);
    if (!tasks) return std::unexpected(tasks.error());
    return add_tasks(*tasks, job.tasks, {}, model, markers, job.options);
  }
  if (job.setup.empty()) return {};
  return add_tasks(setup.tasks, job.setup, setup.coordinate_file, model, markers, job.options);
}

}  // namespace kinemark::pipeline
