// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::skeleton::articulated {

/// A joint that turns about one axis: unit vectors in the axes of its parent and of its child.
struct HingeAxis {
  int joint = 0;
  Eigen::Vector3d in_parent = Eigen::Vector3d::Zero(), in_child = Eigen::Vector3d::Zero();
};

}  // namespace kinemark::skeleton::articulated
