// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::studies {

/// One LED's path by the chain of 1986; column = frame.
struct ClassicPath {
  Eigen::Matrix3Xd raw, filtered;           ///< m
  Eigen::Matrix3Xd velocity, acceleration;  ///< of the filtered path, two-point differences, m/s and m/s^2
};

/// Look-up tables, occluded observations bridged by a spline on each camera's plane, Butterworth at 12 Hz
/// there, midpoint of the rays, differences. Uses only the frame's time, as the paper did.
[[nodiscard]] std::vector<ClassicPath> classic_paths(const data::Counts& counts, const data::Rig& classic,
                                                     const std::vector<std::uint8_t>& usable);

}  // namespace kinemark::studies
