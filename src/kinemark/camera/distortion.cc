// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/distortion.h"

#include <Eigen/LU>
#include <cmath>

namespace kinemark::camera {

Distorted distort(const data::Distortion& d, const Eigen::Vector2d& slopes) {
  const double x = slopes.x(), y = slopes.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const double d_radial = d.k1 + r2 * (2.0 * d.k2 + r2 * 3.0 * d.k3);  // by r2
  const double xy = x * y;
  Distorted out;
  out.slopes << x * radial + 2.0 * d.p1 * xy + d.p2 * (r2 + 2.0 * x * x),
      y * radial + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * xy;
  const double mixed = 2.0 * xy * d_radial + 2.0 * d.p1 * x + 2.0 * d.p2 * y;
  out.d_slopes << radial + 2.0 * x * x * d_radial + 2.0 * d.p1 * y + 6.0 * d.p2 * x, mixed, mixed,
      radial + 2.0 * y * y * d_radial + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  out.d_parameters.row(0) << x * r2, x * r2 * r2, x * r2 * r2 * r2, 2.0 * xy, r2 + 2.0 * x * x;
  out.d_parameters.row(1) << y * r2, y * r2 * r2, y * r2 * r2 * r2, r2 + 2.0 * y * y, 2.0 * xy;
  return out;
}

std::optional<Eigen::Vector2d> undistort(const data::Distortion& distortion,
                                         const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  Eigen::Vector2d slopes = distorted;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Distorted at = distort(distortion, slopes);
    const Eigen::Vector2d miss = at.slopes - distorted;
    // A determinant that is not positive means that the polynomial is no longer increasing.
    if (!(at.d_slopes.determinant() > 0.0)) return std::nullopt;
    if (miss.norm() <= 1e-14 * (1.0 + distorted.norm())) return slopes;
    slopes -= at.d_slopes.inverse() * miss;
  }
  const Distorted at = distort(distortion, slopes);
  if ((at.slopes - distorted).norm() <= 1e-12 * (1.0 + distorted.norm())) return slopes;
  return std::nullopt;
}

}  // namespace kinemark::camera
