// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::math {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rotation about a unit axis by an angle (rad), Rodrigues' formula.
[[nodiscard]] Matrix3d axis_angle(const Vector3d& axis, double angle_rad);

/// Body-fixed X-Y-Z angles (rad) to a rotation, as OpenSim's frames write their orientation: Rx(a) Ry(b)
/// Rz(c).
[[nodiscard]] Matrix3d from_body_xyz(const Vector3d& angles_rad);

/// Inverse of from_body_xyz(); the middle angle lies in [-pi/2, pi/2]. At its ends the third angle is 0.
[[nodiscard]] Vector3d to_body_xyz(const Matrix3d& rotation);

/// Angles t with rotation = R(a0, t0) R(a1, t1) R(a2, t2) about three mutually orthogonal unit axes (columns
/// of `axes`, right- or left-handed). Of the two solutions, and of all full turns, the one nearest to
/// `near_rad` is returned, so that a recording stays continuous. Where the middle angle is +-90 deg only the
/// sum or the difference of the outer angles exists; the first is then kept at near_rad[0].
[[nodiscard]] Vector3d to_angles_about(const Matrix3d& axes, const Matrix3d& rotation,
                                       const Vector3d& near_rad);

/// Exponential map: rotation vector (rad) to rotation matrix.
[[nodiscard]] Matrix3d exp_so3(const Vector3d& rotation_vector_rad);

/// Logarithm: rotation matrix to rotation vector (rad), norm in [0, pi].
[[nodiscard]] Vector3d log_so3(const Matrix3d& rotation);

}  // namespace kinemark::math
