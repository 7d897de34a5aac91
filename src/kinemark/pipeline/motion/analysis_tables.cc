// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/analysis_tables.h"

#include <array>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"

namespace kinemark::pipeline {
namespace {

constexpr std::array kHeadings{"Positions", "Velocities", "Accelerations"};
constexpr std::array kPointOrders{"PointPosition", "PointVelocity", "PointAcceleration"};

data::Table begin_table(std::string name, const TimeBase& time, const RowRange& rows) {
  data::Table table;
  table.name = std::move(name);
  for (auto f = rows.first; f < rows.last; ++f) table.time_s.push_back(time.time_s(f));
  return table;
}

}  // namespace

data::Table coordinate_rates_table(std::string name, const data::JointMotion& motion,
                                   const Array<double>& values, const std::vector<int>& columns,
                                   bool in_degrees, const RowRange& rows) {
  data::Table table = begin_table(std::move(name), motion.time, rows);
  table.in_degrees = in_degrees;
  std::vector<double> unit;
  for (const int c : columns) {
    table.columns.push_back(motion.coordinates[at(c)]);
    const bool keeps_radians = !motion.keeps_radians.empty() && motion.keeps_radians[at(c)];
    unit.push_back(in_degrees && motion.is_rotation[at(c)] && !keeps_radians ? kDegPerRad : 1.0);
  }
  for (auto f = rows.first; f < rows.last; ++f)
    for (std::size_t k = 0; k < columns.size(); ++k)
      table.values.push_back(unit[k] * values[motion.index(f, columns[k])]);
  return table;
}

data::Table bodies_table(const data::ModelDescription& model, const motion::BodyMotion& bodies,
                         const Array<double>& values, const std::vector<int>& body_idx, bool mass_centre,
                         int order, bool in_degrees, const RowRange& rows) {
  data::Table table = begin_table(kHeadings[at(order)], bodies.time, rows);
  table.in_degrees = in_degrees;
  for (const int idx : body_idx)
    for (const char* axis : {"_X", "_Y", "_Z", "_Ox", "_Oy", "_Oz"})
      table.columns.push_back(model.bodies[at(idx)].name + axis);
  if (mass_centre)
    for (const char* axis : {"_X", "_Y", "_Z"}) table.columns.push_back(std::string("center_of_mass") + axis);
  const double angle = in_degrees ? kDegPerRad : 1.0;
  for (auto f = rows.first; f < rows.last; ++f) {
    const double* row = values.data() + bodies.index(f, order, 0);
    for (std::int64_t k = 0; k < std::ssize(table.columns); ++k)
      table.values.push_back(row[k] * (k < 6 * bodies.bodies && k % 6 >= 3 ? angle : 1.0));
  }
  return table;
}

data::Table point_table(const motion::BodyMotion& bodies, const Array<double>& values, std::int64_t point,
                        int order, const RowRange& rows) {
  data::Table table = begin_table(kPointOrders[at(order)], bodies.time, rows);
  table.columns = {"state_0", "state_1", "state_2"};
  for (auto f = rows.first; f < rows.last; ++f)
    for (std::int64_t axis = 0; axis < 3; ++axis)
      table.values.push_back(values[bodies.index(f, order, 6 * bodies.bodies + 3 + 3 * point + axis)]);
  return table;
}

data::Table rows_of(data::Table table, const RowRange& rows) {
  const auto K = std::ssize(table.columns);
  table.values = {table.values.begin() + rows.first * K, table.values.begin() + rows.last * K};
  table.time_s = {table.time_s.begin() + rows.first, table.time_s.begin() + rows.last};
  return table;
}

}  // namespace kinemark::pipeline
