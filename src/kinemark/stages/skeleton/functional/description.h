// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "kinemark/data/skeleton.h"

namespace kinemark::skeleton {

/// What the motion shows of a joint and what it does not: "12 deg of motion: axis direction known to 2 deg,
/// position along it not". Uses range, kind, covariance in the parent and axis SD. Where a ball joint's
/// centre is known to 10 mm or worse and the motion is the reason, it says so: one arc only (the second SD of
/// the rotation is below a quarter of the first; both are given), or too small (the first is below 0.1 rad).
/// Where parts of the trial agree better than 0.7 times the SD about the bone, it says to what, and that the
/// number is prior-dominated where it is.
///
/// @param sd_rad  SD of the rotation from its mean, largest first
[[nodiscard]] std::string describe_joint(const data::SkeletonJoint& joint, const Eigen::Vector3d& sd_rad);

}  // namespace kinemark::skeleton
