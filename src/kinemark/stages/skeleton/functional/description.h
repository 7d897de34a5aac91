// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "kinemark/data/skeleton.h"

namespace kinemark::skeleton {

/// What the motion shows of a joint and what it does not: "12 deg of motion: axis direction known to 2 deg,
/// position along it not". Uses range, kind, covariance in the parent and axis SD.
[[nodiscard]] std::string describe_joint(const data::SkeletonJoint& joint);

}  // namespace kinemark::skeleton
