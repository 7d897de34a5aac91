// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The tables of an analysis, with the labels that OpenSim's have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/table.h"
#include "kinemark/stages/motion/dynamics/body_motion.h"

namespace kinemark::pipeline {

/// Rows [first, last) of a motion.
struct RowRange {
  std::int64_t first = 0, last = 0;                                 ///< frames
  [[nodiscard]] std::int64_t size() const { return last - first; }  ///< number of rows
};

/// A value for each coordinate and frame, one column each.
/// @param values      F x n, in rad, m and their rates
/// @param columns     indices of coordinates
/// @param in_degrees  rotations in degrees instead of radians
[[nodiscard]] data::Table coordinate_rates_table(std::string name, const data::JointMotion& motion,
                                                 const Array<double>& values, const std::vector<int>& columns,
                                                 bool in_degrees, const RowRange& rows);

/// BodyKinematics: BODY_X, _Y, _Z, _Ox, _Oy, _Oz of each body, center_of_mass_X, _Y, _Z if asked for.
/// @param values  BodyMotion::value or sd @param order  0 position, 1 velocity, 2 acceleration
[[nodiscard]] data::Table bodies_table(const data::ModelDescription& model, const motion::BodyMotion& bodies,
                                       const Array<double>& values, const std::vector<int>& body_idx,
                                       bool mass_centre, int order, bool in_degrees, const RowRange& rows);

/// PointKinematics of one point: state_0, state_1, state_2 are x, y, z.
[[nodiscard]] data::Table point_table(const motion::BodyMotion& bodies, const Array<double>& values,
                                      std::int64_t point, int order, const RowRange& rows);

/// Some rows of a table.
[[nodiscard]] data::Table rows_of(data::Table table, const RowRange& rows);

}  // namespace kinemark::pipeline
