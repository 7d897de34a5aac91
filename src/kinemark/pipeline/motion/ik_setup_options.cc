// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/ik_setup_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/io/place.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/motion_tables.h"

namespace kinemark::pipeline {
namespace {

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
