// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/rotation_between.h"

#include <cmath>

namespace kinemark::math {
namespace {

constexpr double kOpposite = -1.0 + 1e-12;  // cosine below which rounding hides the axis

}  // namespace

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (cosine < kOpposite) {
    turn.w() = 0.0;
    turn.vec() = a.unitOrthogonal();
    return turn;
  }
  const Eigen::Vector3d axis = a.cross(b);
  const double s = std::sqrt((1.0 + cosine) * 2.0), inverse = 1.0 / s;
  turn.vec() = axis * inverse;
  turn.w() = s * 0.5;
  return turn;
}

}  // namespace kinemark::math
