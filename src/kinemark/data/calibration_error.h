// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Error of positions that a calibration leaves, as fields over the room: fitted, evaluated, turned, as text.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trial.h"

namespace kinemark::data {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Fields through displacements of points, by least squares: as few as hold all but a thousandth of their
/// variance, 12 at most.
/// @param points_in_world  N x 3, m
/// @param by_draw          3 N x P, m: displacement of x, y, z of each point by each of P standard normal
///                         numbers
[[nodiscard]] CalibrationError fit_calibration_error(const Points& points_in_world,
                                                     const Eigen::MatrixXd& by_draw);

/// Displacement of points by each field: N x 3, m in the world.
[[nodiscard]] std::vector<Points> displacements(const CalibrationError& error, const Points& points_in_world);

/// The same error after the world was turned: new = to_from old.
[[nodiscard]] CalibrationError turned(const CalibrationError& error, const Eigen::Matrix3d& to_from);

/// Numbers with blanks between them: middle, rotation row by row, scale, fields; empty without fields.
[[nodiscard]] std::string to_text(const CalibrationError& error);
/// The error that such a text holds; no value where it is none, or one that is not finite, not a rotation or
/// has more than 12 fields.
[[nodiscard]] std::optional<CalibrationError> calibration_error_of(std::string_view text);

}  // namespace kinemark::data
