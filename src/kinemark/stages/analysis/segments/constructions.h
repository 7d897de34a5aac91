// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Points that conventions construct from markers.
#pragma once

#include <Eigen/Core>

namespace kinemark::analysis {

/// A joint's centre by the chord function of the conventional gait model (Davis et al. 1991): `distance`
/// from the marker at the joint, with the lines to that marker and to the proximal centre perpendicular, in
/// the plane of proximal centre, marker and wand, on the side of the marker that the wand is not on.
///
/// `turn_rad` turns the joint's axis away from the wand: seen along the line from the centre to the proximal
/// centre, from above, the wand lies that angle counter-clockwise of the marker. NaN where
/// the distance to the proximal centre is below `distance`, where the three are in line, and for an angle
/// that no centre has: of 90 deg or more, or larger than a wand so near to the line allows.
[[nodiscard]] Eigen::Vector3d chord(const Eigen::Vector3d& wand, const Eigen::Vector3d& marker,
                                    const Eigen::Vector3d& proximal, double distance, double turn_rad = 0.0);

/// The corner from which three rods of equal length go to a, b and c, perpendicular to each other: where a
/// knee alignment device touches. Where the measured triangle is not equilateral, below its centroid by the
/// root mean square of its sides over sqrt(6). Of both corners the one nearer to `towards`. NaN where the
/// three are in line.
[[nodiscard]] Eigen::Vector3d corner(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c, const Eigen::Vector3d& towards);

/// The angle by which `to` is turned from `from` about `axis`, both seen along it, rad in (-pi, pi],
/// counter-clockwise where the axis points at the eye. NaN where either is along the axis.
[[nodiscard]] double turn_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to);

}  // namespace kinemark::analysis
