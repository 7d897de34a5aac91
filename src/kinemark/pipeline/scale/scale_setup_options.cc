// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_setup_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/motion_tables.h"

namespace kinemark::pipeline {
namespace {

double bounded(double time_s) { return std::clamp(time_s, -1e300, 1e300); }

/// The value of a coordinate's column in the row nearest to the middle of the placement's time range.
Result<double> value_from_file(const io::ScaleSetup& setup, const data::Table& table,
                               const data::ModelDescription& model, int coordinate_idx) {
  const auto& name = model.coordinates[static_cast<std::size_t>(coordinate_idx)].name;
  const auto column = table.find(name);
  if (column < 0 || table.rows() == 0)
    return fail(Code::bad_input, fmt::format("{}: has no value of '{}', which a task takes from it",
                                             setup.coordinate_file.string(), name));
  const double begin = std::max(setup.place_begin_s, table.time_s.front()),
               end = std::min(setup.place_end_s, table.time_s.back());
  std::int64_t nearest = 0;
  for (std::int64_t row = 1; row < table.rows(); ++row) {
    const auto away = [&](std::int64_t r) {
      return std::abs(table.time_s[static_cast<std::size_t>(r)] - 0.5 * (begin + end));
    };
    if (away(row) < away(nearest)) nearest = row;
  }
  return table(nearest, column) * column_unit(table, model, coordinate_idx);
}

}  // namespace

Result<motion::PlaceOptions> place_options(const io::ScaleSetup& setup,
                                           const std::vector<io::MarkerOfSet>& set,
                                           const data::ModelDescription& model) {
  motion::PlaceOptions options;
  options.ik.first_time_s = bounded(setup.place_begin_s);
  options.ik.last_time_s = bounded(setup.place_end_s);
  if (setup.max_marker_movement_mm >= 0.0)
    options.max_marker_movement_m = 1e-3 * setup.max_marker_movement_mm;
  for (const auto& marker : set)
    if (marker.fixed) options.fixed.push_back(marker.name);
  if (!setup.tasks.markers.empty()) options.ik.default_marker_weight = 0.0;
  for (const auto& task : setup.tasks.markers)
    if (model.find_marker(task.name) >= 0)
      options.ik.marker_weights.push_back({.marker = task.name, .weight = task.apply ? task.weight : 0.0});

  std::optional<data::Table> table;
  for (const auto& task : setup.tasks.coordinates) {
    if (!task.apply || task.weight == 0.0) continue;
    const int c = model.find_coordinate(task.name);
    if (c < 0)
      return fail(Code::bad_input,
                  fmt::format("a task names coordinate '{}', which the model does not have", task.name));
    const auto& coordinate = model.coordinates[static_cast<std::size_t>(c)];
    double value = task.value;
    if (task.target == io::IkCoordinateTask::Target::default_value) value = coordinate.default_value;
    if (task.target == io::IkCoordinateTask::Target::from_file) {
      if (setup.coordinate_file.empty())
        return fail(Code::bad_input,
                    fmt::format("the task of coordinate '{}' takes its value from a file, but the "
                                "setup names no coordinate_file",
                                task.name));
      if (!table) {
        auto read = io::read_table(setup.coordinate_file);
        if (!read) return std::unexpected(read.error());
        table = std::move(*read);
      }
      const auto found = value_from_file(setup, *table, model, c);
      if (!found) return std::unexpected(found.error());
      value = *found;
    }
    options.ik.coordinate_tasks.push_back({.coordinate = task.name, .weight = task.weight, .value = value});
  }
  return options;
}

}  // namespace kinemark::pipeline
