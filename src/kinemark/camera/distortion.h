// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Slopes behind the lens, with their derivatives.
struct Distorted {
  Eigen::Vector2d slopes;                    ///< X/Z and Y/Z behind the lens, no unit
  Eigen::Matrix2d d_slopes;                  ///< by the slopes before the lens
  Eigen::Matrix<double, 2, 5> d_parameters;  ///< by k1, k2, k3, p1, p2
};

/// Slopes X/Z, Y/Z of a ray after Brown's distortion (data::Distortion). Brown (1966), Photogramm. Eng.
/// 32:444.
[[nodiscard]] Distorted distort(const data::Distortion& distortion, const Eigen::Vector2d& slopes);

/// Inverse of distort() by Newton's method, to 1e-14. No value where it does not converge: beyond the circle
/// in which the radial polynomial grows, no ray arrives.
[[nodiscard]] std::optional<Eigen::Vector2d> undistort(const data::Distortion& distortion,
                                                       const Eigen::Vector2d& distorted);

}  // namespace kinemark::camera
