// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Balance: the extrapolated mass centre in the base of support. Lengths in m, horizontal points as 2-vectors.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/stages/analysis/body/body_series.h"

namespace kinemark::analysis {

/// Two horizontal directions, e1 x e2 = up. e1 is the world axis next to level that comes first.
struct Level {
  Eigen::Vector3d e1, e2;  ///< length 1
  /// Along e1 and e2.
  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector3d& x) const { return {e1.dot(x), e2.dot(x)}; }
};
/// @param up  length 1
[[nodiscard]] Level level_of(const Eigen::Vector3d& up);

/// Corners of the convex hull, counterclockwise; of fewer than three points or of points on a line, its ends.
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// Distance of a point from the border of a hull, positive inside; NaN without corners.
[[nodiscard]] double distance_inside(const Eigen::Vector2d& point, std::span<const Eigen::Vector2d> hull);

/// Extrapolated mass centre: x + v / sqrt(g / l) (Hof, Gazendam & Sinke 2005, eq. 7).
/// @param pendulum  l, length of the inverted pendulum
[[nodiscard]] inline Eigen::Vector2d extrapolated(const Eigen::Vector2d& x, const Eigen::Vector2d& v,
                                                  double pendulum, double gravity) {
  return x + v * std::sqrt(pendulum / gravity);
}

/// When each foot bears load, F x 2: its lowest point within 30 mm of the height that it is below in a tenth
/// of the frames, and slower than 0.4 m/s there.
[[nodiscard]] Eigen::MatrixX<bool> feet_on_ground(const BodySeries& series, const Eigen::Vector3d& up,
                                                  double rate_hz);

/// Margins of stability over a stretch, frame by frame: the signed distance of the extrapolated mass centre
/// from the border of the hull of what stands of both feet; NaN where none stands. l is the mean height of
/// the mass centre over the lowest point of the feet in the stretch.
/// @param contact  F x 2
[[nodiscard]] Eigen::VectorXd stability_margins(const BodySeries& series, const BodyRecord& record,
                                                const Eigen::MatrixX<bool>& contact, std::int64_t first,
                                                std::int64_t count);

/// The same towards the side of one foot while it stands: from the extrapolated mass centre to the outermost
/// point of the foot, across the horizontal velocity of the mass centre over the stretch. All NaN where that
/// is below 0.2 m/s: what is sideways is not known then.
[[nodiscard]] Eigen::VectorXd lateral_margins(const BodySeries& series, const BodyRecord& record,
                                              const Eigen::MatrixX<bool>& contact, data::Side side,
                                              std::int64_t first, std::int64_t count);

}  // namespace kinemark::analysis
