// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/data/calibration_error.h"

namespace kinemark::reconstruction {

/// Fields through displacements of points, by least squares: as few as hold all but a thousandth of their
/// variance, CalibrationError::kMostFields at most.
/// @param points_in_world  N x 3, m
/// @param by_draw          3 N x P, m: displacement of x, y, z of each point by each of P standard normal
///                         numbers
[[nodiscard]] data::CalibrationError fit_calibration_error(const data::Points& points_in_world,
                                                           const Eigen::MatrixXd& by_draw);

}  // namespace kinemark::reconstruction
