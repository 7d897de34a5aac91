// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How far two shapes differ, whatever their axes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace kinemark::skeleton::testing_limbs {

/// Largest difference between the distances of two sets of points: no choice of axes changes it.
inline double distance_error(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      worst = std::max(worst, std::abs((a.col(i) - a.col(j)).norm() - (b.col(i) - b.col(j)).norm()));
  return worst;
}

}  // namespace kinemark::skeleton::testing_limbs
