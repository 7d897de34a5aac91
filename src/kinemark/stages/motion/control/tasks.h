// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Goals that are not points: orientation of a segment, value of a coordinate, distance of two points, centre
// of mass of the whole body.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/stages/motion/control/task.h"

namespace kinemark::motion {

/// Rotate a body's axes to those of the goal: 3 rows, rotation vector in world axes.
/// @param body         name in the model
/// @param world_from_body  goals at the instants of `time` (as many), or one that stays
/// @param lever_m      > 0; a rotation of 1 rad counts like a marker at this distance
[[nodiscard]] std::shared_ptr<Task> orientation_task(std::string body,
                                                     std::vector<Eigen::Quaterniond> world_from_body,
                                                     const TimeBase& time, double lever_m = 0.1);

/// Drive an independent coordinate (not one of a free root) to a value: 1 row, rad or m.
[[nodiscard]] std::shared_ptr<Task> coordinate_task(std::string coordinate, const std::vector<double>& values,
                                                    const TimeBase& time, double lever_m = 0.1);

/// A point that rides on a body.
struct BodyPoint {
  std::string body;                                     ///< "" or "ground": fixed in the world
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
};
/// Keep two points at a distance: 1 row, m.
/// @param distances_m  > 0, at the instants of `time`, or one that stays
/// @param weight  1 counts like a marker's metre
[[nodiscard]] std::shared_ptr<Task> distance_task(BodyPoint a, BodyPoint b,
                                                  const std::vector<double>& distances_m,
                                                  const TimeBase& time, double weight = 1.0);

/// Keep the centre of mass of all bodies that can move at a place along one axis of the world: 1 row, m.
/// @param axis    0, 1, 2: x, y, z
/// @param weight  1 counts like a marker's metre
[[nodiscard]] std::shared_ptr<Task> mass_centre_task(int axis, const std::vector<double>& values_m,
                                                     const TimeBase& time, double weight = 1.0);

}  // namespace kinemark::motion
