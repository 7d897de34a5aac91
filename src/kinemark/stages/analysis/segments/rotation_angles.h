// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A rotation as angles: about three axes of which each is carried by the one before, or about one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/math/se3.h"

namespace kinemark::analysis {

/// Axes of a sequence, each of 0 (x), 1 (y), 2 (z): three different ones (Cardan), or the third as the first
/// (Euler).
using AngleSequence = std::array<int, 3>;

/// "yxz" or "yxy", in small or capital letters. Code::bad_input where neighbours are equal.
[[nodiscard]] Result<AngleSequence> parse_sequence(std::string_view text);

/// Angles, rad, with parent_from_child = R(first) R(second) R(third), in the order of the sequence. The
/// second lies in [-pi/2, pi/2] of a Cardan sequence, in [0, pi] of an Euler one, the others in [-pi, pi].
/// Gimbal lock: where the second is within 1e-7 rad of +-pi/2 (Cardan), or of 0 or pi (Euler), only the sum
/// or the difference of the other two exists, and both are NaN. Grood & Suntay 1983; Wu & Cavanagh 1995.
[[nodiscard]] Eigen::Vector3d sequence_angles(const Eigen::Matrix3d& parent_from_child,
                                              const AngleSequence& sequence);

/// Distance of the second angle from gimbal lock, rad, in [0, pi/2].
[[nodiscard]] double distance_from_lock(double second_rad, const AngleSequence& sequence);

/// Such a distance below which the first and the third say little: a turn of a segment by a degree changes
/// them by 11 and more.
inline constexpr double kNearGimbalLock_rad = 0.0872664625997165;

/// The screw that takes a body from one pose to another.
struct HelicalAxis {
  double angle_rad = 0.0;                                ///< [0, pi]
  double translation_m = 0.0;                            ///< along the axis
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< length 1; NaN without rotation
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the axis, nearest to the origin, m; NaN so too
};

/// The finite helical axis of a displacement (Spoor & Veldpaus 1980).
[[nodiscard]] HelicalAxis helical_axis(const math::SE3& displacement);

}  // namespace kinemark::analysis
