// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The shape of a path, whatever its timing. Positions are n x 3, m; NaN of what too few or equal samples do
// not determine.
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// Sum of the distances from sample to sample, m. Noise can only lengthen it.
[[nodiscard]] double path_length(const SeriesMatrix& x);

/// Distance from the first to the last sample over the path length: 1 of a straight way.
[[nodiscard]] double straightness(const SeriesMatrix& x);

/// Directions in which a path spreads most, next and least (principal components): the last is the normal of
/// its best-fit plane, in the sense of total least squares.
struct PrincipalAxes {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();  ///< of the positions, m
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();    ///< unit vectors in its columns, right-handed
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();    ///< along them, m^2, over n, descending
};
/// Signs so that the first two axes point to the farther end of the path along them.
[[nodiscard]] PrincipalAxes principal_axes(const SeriesMatrix& x);

/// Positions in the frame of the axes: n x 3, along them.
[[nodiscard]] SeriesMatrix along_axes(const SeriesMatrix& x, const PrincipalAxes& axes);

/// Distances of the samples from their mean, m: the median over samples of the distance to the farthest other
/// sample, and the largest of all distances. Of long paths every k-th sample, 240 at most.
struct Diameters {
  double median_farthest = 0.0;  ///< as Poizner, Wooten & Salot (1986) take the diameter of a wheel
  double largest = 0.0;          ///< between any two samples
};
[[nodiscard]] Diameters diameters(const SeriesMatrix& x);

/// Diameter of the circle of least squared distances, m, in the plane of two coordinates (n x 2 or more
/// columns, the first two count). Algebraic start (Kasa 1976), then Newton's method.
[[nodiscard]] double circle_diameter(const SeriesMatrix& in_plane);

/// Axes of the ellipse fitted to the first two columns by direct least squares (Halir & Flusser 1998), m.
struct EllipseAxes {
  double major = 0.0;  ///< whole length of the longer axis
  double minor = 0.0;  ///< of the shorter one
};
/// NaN where no ellipse fits.
[[nodiscard]] EllipseAxes ellipse_axes(const SeriesMatrix& in_plane);

/// Sides of the smallest box around all samples, descending, m.
///
/// From the box along the principal axes, each side in turn is turned to the least area of the rectangle
/// around the path seen along it (exact: one edge of the hull lies on it, Freeman & Shapira 1975) until the
/// volume no longer falls: a local minimum, never larger than the box along the principal axes.
[[nodiscard]] Eigen::Vector3d smallest_box(const SeriesMatrix& x);

/// Median over the samples faster than a tenth of the peak speed of |v x a| / |v|^3, 1/m.
[[nodiscard]] double median_curvature(const PathSamples& path);

/// Median over the same samples, those with a curvature, of |(v x a) . j| / |v x a|^2, 1/m.
[[nodiscard]] double median_torsion(const PathSamples& path);

/// The exponent b of |v| ~ curvature^-b by least squares of the logarithms over the same samples: 1/3 of a
/// harmonic ellipse (Lacquaniti, Terzuolo & Viviani 1983).
[[nodiscard]] double power_law_exponent(const PathSamples& path);

}  // namespace kinemark::analysis
