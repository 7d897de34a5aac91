// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The shape of a path, whatever its timing. Positions are n x 3, m; NaN of what too few or equal samples do
// not determine.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// Sum of the distances from sample to sample, m. Noise can only lengthen it.
[[nodiscard]] double path_length(const PathMatrix& x);

/// Distance from the first to the last sample over the path length: 1 of a straight way.
[[nodiscard]] double straightness(const PathMatrix& x);

/// Directions in which a path spreads most, next and least (principal components): the last is the normal of
/// its best-fit plane, in the sense of total least squares.
struct PrincipalAxes {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();  ///< of the positions, m
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();    ///< unit vectors in its columns, right-handed
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();    ///< along them, m^2, over n, descending
};
/// Signs so that the first two axes point to the farther end of the path along them.
[[nodiscard]] PrincipalAxes principal_axes(const PathMatrix& x);

/// Positions in the frame of the axes: n x 3, along them.
[[nodiscard]] PathMatrix along_axes(const PathMatrix& x, const PrincipalAxes& axes);

/// Distances of the samples from their mean, m: the median over samples of the distance to the farthest other
/// sample, and the largest of all distances. Of long paths every k-th sample, 240 at most.
struct Diameters {
  double median_farthest = 0.0;  ///< as Poizner, Wooten & Salot (1986) take the diameter of a wheel
  double largest = 0.0;          ///< between any two samples
};
[[nodiscard]] Diameters diameters(const PathMatrix& x);

/// Diameter of the circle of least squared distances, m, in the plane of two coordinates (n x 2 or more
/// columns, the first two count). Algebraic start (Kasa 1976), then Newton's method.
[[nodiscard]] double circle_diameter(const PathMatrix& in_plane);

/// Axes of the ellipse fitted to the first two columns by direct least squares (Halir & Flusser 1998), m.
struct EllipseAxes {
  double major = kNaN;  ///< whole length of the longer axis
  double minor = kNaN;  ///< of the shorter one
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d form = Eigen::Matrix2d::Zero();  ///< (p - centre)' form (p - centre) = 1 on the ellipse
};
/// Lengths of NaN where no ellipse fits.
[[nodiscard]] EllipseAxes ellipse_axes(const PathMatrix& in_plane);

/// Ratio of the axes of a path that goes around, by what is spread about its mean: root of the ratio of the
/// two larger eigenvalues of the covariance, over the time from the first sample to `end` (trapezoids). Of a
/// circle it is 1 over whole turns alone; over T turns it is near 1 + |sin 2 pi T| / (2 pi T).
/// @param end  sample, between two, n - 1 at most
[[nodiscard]] double spread_ratio(const PathMatrix& x, double end);

/// Largest over least width of the first two columns, over all directions of their plane: the ratio of the
/// axes of a path that goes around once or more. Of long paths every k-th sample, 4096 at most. NaN of less
/// than three samples or no width.
[[nodiscard]] double width_ratio(const PathMatrix& in_plane);

/// Sides of the smallest box around all samples, descending, m.
///
/// From the box along the principal axes, each side in turn is turned to the least area of the rectangle
/// around the path seen along it (exact: one edge of the hull lies on it, Freeman & Shapira 1975) until the
/// volume no longer falls: a local minimum, never larger than the box along the principal axes.
[[nodiscard]] Eigen::Vector3d smallest_box(const PathMatrix& x, const PrincipalAxes& principal);

/// Which samples of a path lie near its hull, for the boxes of paths that lie near it.
struct OuterSamples {
  using Triangle = std::array<std::int64_t, 3>;  ///< samples, counter-clockwise from outside
  std::vector<std::int64_t>
      order;  ///< all samples, those nearest to the hull, or outside of what is known of it, first
  std::vector<double> depth;          ///< of each of these at least, m; empty where little would be gained
  std::vector<Triangle> coarse;       ///< faces of the hull of its farthest samples along 13 axes both ways
  std::vector<std::int64_t> corners;  ///< samples that depths are counted from, ascending
};
/// Cost: n, and of long paths some ten milliseconds.
[[nodiscard]] OuterSamples outer_samples(const PathMatrix& x);

/// The smallest box of a path near another: the same as without that knowledge, for less.
/// @param near    outer_samples() of the other path
/// @param near_x  the other path, with as many samples
[[nodiscard]] Eigen::Vector3d smallest_box(const PathMatrix& x, const PrincipalAxes& principal,
                                           const OuterSamples& near, const PathMatrix& near_x);

/// Distance of every row of one path from the same row of another, n, m.
[[nodiscard]] Eigen::VectorXd deviations(const PathMatrix& x, const PathMatrix& other);

/// What curvature and torsion are made of, at the samples faster than a tenth of the peak speed.
struct CurvatureTerms {
  std::vector<double> speed_squared;  ///< |v|^2, m^2/s^2
  std::vector<double> cross_squared;  ///< |v x a|^2, m^4/s^6
  std::vector<double> triple;         ///< (v x a) . j, m^3/s^6
};
/// Cost: n.
[[nodiscard]] CurvatureTerms curvature_terms_of(const PathSamples& path);

/// Median over the samples faster than a tenth of the peak speed of |v x a| / |v|^3, 1/m.
[[nodiscard]] double median_curvature(const CurvatureTerms& terms);

/// Median over the same samples, those with a curvature, of |(v x a) . j| / |v x a|^2, 1/m.
[[nodiscard]] double median_torsion(const CurvatureTerms& terms);

/// The exponent b of |v| ~ curvature^-b by least squares of the logarithms over the same samples: 1/3 of a
/// harmonic ellipse (Lacquaniti, Terzuolo & Viviani 1983).
[[nodiscard]] double power_law_exponent(const CurvatureTerms& terms);

}  // namespace kinemark::analysis
