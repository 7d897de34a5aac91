// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace kinemark::math {

/// The least rotation that turns one direction into another, as Eigen's FromTwoVectors(), but without its
/// singular value decomposition for opposite directions, which is slow to compile.
///
/// @param from  any length but 0, finite, any unit
/// @param to    any length but 0, finite, any unit
/// @return  a unit quaternion; for directions opposite to within 1.4e-6 rad half a turn about one of the axes
///          across them. O(1).
[[nodiscard]] Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace kinemark::math
