// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint motion as the tables that MOT and STO files hold (degrees and metres), and back.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/table.h"

namespace kinemark::pipeline {

/// Coordinates, one column each; rotations in degrees but those that keep radians.
[[nodiscard]] data::Table coordinates_table(const data::JointMotion& motion);

/// One standard deviation of each coordinate, degrees or metres; NaN where the markers do not determine it.
[[nodiscard]] data::Table deviations_table(const data::JointMotion& motion);

/// What the error of each coordinate cannot exceed, degrees or metres; NaN where not determined.
[[nodiscard]] data::Table bounds_table(const data::JointMotion& motion);

/// Generalised forces, one column per coordinate: "knee_moment" in N m, "pelvis_tx_force" in N; OpenSim says
/// "_force" of a rotation that keeps radians too, and so do we.
[[nodiscard]] data::Table torques_table(const data::JointMotion& motion);
/// The standard deviations in a table of the same shape; NaN where not known.
[[nodiscard]] data::Table torque_deviations_table(const data::JointMotion& motion);

/// Distance between measured and model marker in metres: columns rms, max, then one per marker; NaN where not
/// seen.
[[nodiscard]] data::Table marker_errors_table(const data::JointMotion& motion);

/// What 1 in the column of a model's coordinate stands for, rad or m.
[[nodiscard]] double column_unit(const data::Table& table, const data::ModelDescription& model,
                                 int coordinate_idx);

/// Names of coordinates whose columns are not lengths.
struct RotationNames {
  std::vector<std::string> all;            ///< every rotation
  std::vector<std::string> keeps_radians;  ///< those of `all` that are in rad where the table is in degrees
};

/// A motion from a table of coordinates and, when given, of deviations and marker errors; the result is in
/// radians and metres. The marker error gets its length in x and 0 in y and z; with both tables each frame
/// has a status (the tables do not show which frames did not converge).
[[nodiscard]] Result<data::JointMotion> motion_from_tables(const data::Table& coordinates,
                                                           const data::Table* deviations,
                                                           const data::Table* marker_errors,
                                                           const RotationNames& rotations);

}  // namespace kinemark::pipeline
