// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Error of positions that a calibration leaves, as fields over the room: evaluated, turned, as text.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trial.h"

namespace kinemark::data {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The polynomial's terms at N points.
using CalibrationTerms = Eigen::Matrix<double, Eigen::Dynamic, CalibrationError::kTerms>;
[[nodiscard]] CalibrationTerms terms_of(const CalibrationError& error, const Points& points_in_world);

/// Displacement of points by each field: N x 3, m in the world.
[[nodiscard]] std::vector<Points> displacements(const CalibrationError& error, const Points& points_in_world);

/// The same error after the world was turned: new = to_from old.
[[nodiscard]] CalibrationError turned(const CalibrationError& error, const Eigen::Matrix3d& to_from);

/// What it leaves unknown of a marker in the root mean square over samples, m; 0 of none. Of long recordings
/// every k-th frame.
[[nodiscard]] double rms_of(const CalibrationError& error, const Trajectories& markers);

/// One sentence of it: how far all positions may be off alike; empty where nothing is known of it.
[[nodiscard]] std::string describe(const CalibrationError& error, const Trajectories& markers);

/// That these hold it ("Intervals"), with what it leaves unknown of positions; empty where that is nothing.
/// @param unknown_m  root mean square, as rms_of()
[[nodiscard]] std::string note_held(std::string_view what, double unknown_m);

/// Numbers with blanks between them: middle, rotation row by row, scale, fields; empty without fields.
[[nodiscard]] std::string to_text(const CalibrationError& error);
/// The error that such a text holds; no value where it is none, or one that is not finite, not a rotation or
/// has more than 12 fields.
[[nodiscard]] std::optional<CalibrationError> calibration_error_of(std::string_view text);

}  // namespace kinemark::data
