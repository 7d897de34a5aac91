// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/motion_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::pipeline {
namespace {

data::Table empty_table(const data::JointMotion& motion, std::string name) {
  data::Table table;
  table.name = std::move(name);
  table.time_s.resize(at(motion.frames()));
  for (std::int64_t f = 0; f < motion.frames(); ++f) table.time_s[at(f)] = motion.time.time_s(f);
  return table;
}

/// What a file holds instead of 1 rad or 1 m of a coordinate.
double file_unit(const data::JointMotion& motion, std::size_t coordinate) {
  const bool keeps_radians = !motion.keeps_radians.empty() && motion.keeps_radians[coordinate];
  return motion.is_rotation[coordinate] && !keeps_radians ? kDegPerRad : 1.0;
}

data::Table coordinate_columns(const data::JointMotion& motion, const Array<double>& values,
                               std::string name) {
  data::Table table = empty_table(motion, std::move(name));
  table.in_degrees = true;
  table.columns = motion.coordinates;
  table.values.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    table.values[i] = values[i] * file_unit(motion, i % motion.coordinates.size());
  return table;
}

data::Table forces_table(const data::JointMotion& motion, const Array<double>& values, std::string name) {
  data::Table table = empty_table(motion, std::move(name));
  for (std::size_t c = 0; c < motion.coordinates.size(); ++c)
    table.columns.push_back(motion.coordinates[c] + (file_unit(motion, c) != 1.0 ? "_moment" : "_force"));
  table.values = values;
  return table;
}

/// Rate of evenly spaced times, or an error that names the first uneven row.
Result<TimeBase> time_base_of(const data::Table& table) {
  const auto n = table.rows();
  if (n == 0) return fail(Code::bad_input, "the table has no rows");
  if (n == 1) return TimeBase{.rate_hz = 1.0, .t0_s = table.time_s[0], .frames = 1};
  const double span = table.time_s.back() - table.time_s.front();
  TimeBase time{.rate_hz = static_cast<double>(n - 1) / span, .t0_s = table.time_s.front(), .frames = n};
  const double rounded = std::round(time.rate_hz * 100.0) / 100.0;
  if (std::abs(rounded - time.rate_hz) < 1e-4 * rounded) time.rate_hz = rounded;
  for (std::int64_t i = 0; i < n; ++i)
    if (std::abs(table.time_s[at(i)] - time.time_s(i)) > 0.1 / time.rate_hz)
      return fail(Code::bad_input, fmt::format("time of row {} is {} s; need even steps of {} s", i + 1,
                                               table.time_s[at(i)], 1.0 / time.rate_hz));
  return time;
}

}  // namespace

data::Table coordinates_table(const data::JointMotion& motion) {
  return coordinate_columns(motion, motion.q, "Coordinates");
}

data::Table deviations_table(const data::JointMotion& motion) {
  return coordinate_columns(motion, motion.q_sd, "Standard deviations of coordinates");
}

data::Table bounds_table(const data::JointMotion& motion) {
  return coordinate_columns(motion, motion.q_bound, "Bounds of coordinates");
}

data::Table torques_table(const data::JointMotion& motion) {
  return forces_table(motion, motion.tau, "Generalised forces in N m and N");
}

data::Table torque_deviations_table(const data::JointMotion& motion) {
  return forces_table(motion, motion.tau_sd, "Standard deviations of generalised forces in N m and N");
}

data::Table marker_errors_table(const data::JointMotion& motion) {
  data::Table table = empty_table(motion, "Marker errors in metres");
  table.columns = {"rms", "max"};
  table.columns.insert(table.columns.end(), motion.markers.begin(), motion.markers.end());
  const auto M = static_cast<std::int64_t>(motion.markers.size());
  table.values.reserve(at(motion.frames() * (M + 2)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const double* errors = motion.marker_error.data() + 3 * f * M;
    double squares = 0.0, largest = nan;
    std::int64_t seen = 0;
    const auto row = table.values.size();
    table.values.resize(row + at(M + 2), nan);
    for (std::int64_t m = 0; m < M; ++m) {
      const double d = std::hypot(errors[3 * m], errors[3 * m + 1], errors[3 * m + 2]);
      table.values[row + 2 + at(m)] = d;
      if (std::isnan(d)) continue;
      squares += d * d;
      largest = seen == 0 ? d : std::max(largest, d);
      ++seen;
    }
    table.values[row] = seen > 0 ? std::sqrt(squares / static_cast<double>(seen)) : nan;
    table.values[row + 1] = largest;
  }
  return table;
}

double column_unit(const data::Table& table, const data::ModelDescription& model, int coordinate_idx) {
  const bool degrees = model.coordinates[at(coordinate_idx)].is_rotation && io::angles_are_degrees(table) &&
                       !data::keeps_radians(model, coordinate_idx);
  return degrees ? kRadPerDeg : 1.0;
}

Result<data::JointMotion> motion_from_tables(const data::Table& coordinates, const data::Table* deviations,
                                             const data::Table* marker_errors,
                                             const RotationNames& rotations) {
  auto time = time_base_of(coordinates);
  if (!time) return std::unexpected(time.error());
  data::JointMotion motion;
  motion.time = *time;
  motion.coordinates = coordinates.columns;
  const auto among = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const auto& name : motion.coordinates) {
    motion.is_rotation.push_back(among(rotations.all, name));
    motion.keeps_radians.push_back(among(rotations.keeps_radians, name));
  }
  const auto n = motion.coordinates.size();
  const auto radians = [&](std::size_t i, double value, bool degrees) {
    return degrees && file_unit(motion, i % n) != 1.0 ? value * kRadPerDeg : value;
  };
  motion.q.resize(coordinates.values.size());
  for (std::size_t i = 0; i < motion.q.size(); ++i)
    motion.q[i] = radians(i, coordinates.values[i], coordinates.in_degrees);
  if (deviations) {
    if (deviations->columns != coordinates.columns || deviations->rows() != coordinates.rows())
      return fail(Code::bad_input, "the standard deviations have other columns or rows than the coordinates");
    motion.q_sd.resize(motion.q.size());
    motion.determined.resize(motion.q.size());
    for (std::size_t i = 0; i < motion.q.size(); ++i) {
      motion.q_sd[i] = radians(i, deviations->values[i], deviations->in_degrees);
      motion.determined[i] = !std::isnan(motion.q_sd[i]);
    }
  }
  if (marker_errors) {
    if (marker_errors->rows() != coordinates.rows())
      return fail(Code::bad_input, "the marker errors have other rows than the coordinates");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& column : marker_errors->columns)
      if (column != "rms" && column != "max") motion.markers.push_back(column);
    for (std::int64_t f = 0; f < motion.frames(); ++f)
      for (const auto& marker : motion.markers) {
        const double d = (*marker_errors)(f, marker_errors->find(marker));
        for (const double axis : {d, 0.0, 0.0}) motion.marker_error.push_back(std::isnan(d) ? nan : axis);
      }
  }
  if (deviations && marker_errors) {
    const auto M = static_cast<std::int64_t>(motion.markers.size());
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto* errors = motion.marker_error.data() + 3 * f * M;
      const auto* determined = motion.determined.data() + motion.index(f, 0);
      const bool blind = std::all_of(errors, errors + 3 * M, [](double e) { return std::isnan(e); });
      const bool free = std::any_of(determined, determined + n, [](auto d) { return d == 0; });
      motion.status.push_back(blind  ? data::FrameStatus::no_markers
                              : free ? data::FrameStatus::underdetermined
                                     : data::FrameStatus::converged);
    }
  }
  return motion;
}

}  // namespace kinemark::pipeline
