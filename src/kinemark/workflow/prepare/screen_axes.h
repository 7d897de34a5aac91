// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Axes of the screen, POINT:X_SCREEN and POINT:Y_SCREEN: what a C3D file says of which way is up.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "kinemark/data/trial.h"

namespace kinemark::workflow {

/// "+Z" of an axis, in the letters of a C3D file; empty: it is none.
[[nodiscard]] std::string letters_of_axis(const Eigen::Vector3d& axis);

/// The axis that the recording says goes up the screen; none where it says none.
[[nodiscard]] std::optional<Eigen::Vector3d> screen_up(const data::Trial& trial);

/// Say that this axis goes up the screen, and the next one of x, y, z across it; a file that keeps parameters
/// of C3D is written with it.
void set_screen_up(data::Trial& trial, const Eigen::Vector3d& axis);

}  // namespace kinemark::workflow
