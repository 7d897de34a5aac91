// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording in other axes: what the words for it mean, and all of it turned alike.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::workflow {

/// "x", "y", "z", "-x", "-y" or "-z" as a unit vector; a plus in front and capitals are allowed. Anything
/// else: Code::usage.
[[nodiscard]] Result<Eigen::Vector3d> parse_axis(std::string_view text);
/// The axis that a direction lies along to 10 deg, "z" or "-z"; else its three numbers.
[[nodiscard]] std::string name_of_direction(const Eigen::Vector3d& direction);

/// The rotation of "x -90": an axis and degrees, counter-clockwise when seen from its tip. Several, "x -90 z
/// 180", follow one another, each about the axes of the laboratory. Multiples of 90 deg exchange and negate
/// coordinates and change no digit. Anything else: Code::usage.
[[nodiscard]] Result<Eigen::Matrix3d> parse_rotation(std::string_view text);

/// The smallest rotation that brings one unit vector to another; between axes it is exact. Half turns go
/// about x, or about y where x is the axis.
[[nodiscard]] Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Turn everything of a trial that has a direction: positions, their covariances, modelled
/// markers, force plates. Other outputs of a model are in the axes of its segments and stay.
/// @param to_from  rotation, x_new = to_from x_old
void turn(data::Trial& trial, const Eigen::Matrix3d& to_from);
/// Turn forces, moments and their points.
void turn(data::Wrenches& wrenches, const Eigen::Matrix3d& to_from);

}  // namespace kinemark::workflow
