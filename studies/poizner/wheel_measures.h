// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::studies {

/// The paper's measures of a turning wheel.
struct WheelMeasures {
  double median_error_m = 0.0;  ///< of the diameters, against the true one
  double sd_m = 0.0;            ///< of the diameters
  double max_error_m = 0.0;     ///< largest, unsigned
  double spread_ratio = 1.0;    ///< of the axes, by the spread about their mean over whole turns
  double spread_of_all = 1.0;   ///< the same over all samples, whole turns or not
  double width_ratio = 1.0;     ///< of the axes, largest over least width in the best-fit plane
  double ellipse_ratio = 1.0;   ///< of the axes of the fitted ellipse
  double plane_sd_m = 0.0;      ///< across that plane
  double circle_error_m = 0.0;  ///< diameter of the circle of least squared distances, against the true one
};

/// Points of a circle in its best-fit plane: columns, m.
struct PlaneView {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;       ///< columns: along most, along less, across
  Eigen::Matrix2Xd in_plane;  ///< m
  Eigen::VectorXd across;     ///< m
};

[[nodiscard]] PlaneView best_fit_plane(const Eigen::Matrix3Xd& points);

/// Each point's diameter is its distance to the farthest other point. Ratios of the axes and the circle are
/// those that `kinemark measure` takes; the plane's scatter is over the points less three. At least four
/// points. O(points^2).
[[nodiscard]] WheelMeasures measure_wheel(const Eigen::Matrix3Xd& points, double true_diameter_m);

}  // namespace kinemark::studies
