// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Sway of somebody who stands: measures of the path of the centre of pressure (Prieto et al. 1996), beside
// path_length() (TOTEX).
#pragma once

#include <Eigen/Core>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::analysis {

/// Mean distance of the points from their mean, m (MDIST).
[[nodiscard]] double mean_distance(const math::SeriesMatrix& x);
/// Area of the ellipse that holds 95 % of the points of a bivariate normal path, m^2: 2 pi F sqrt(s1^2 s2^2 -
/// s12^2) with F the 95 % point of Fisher's distribution with 2 and n - 2 degrees of freedom, covariances
/// over n (AREA-CE). NaN of fewer than four points.
/// @param x  n x 2
[[nodiscard]] double ellipse_area(const math::SeriesMatrix& x);
/// Frequency of a circle of radius mean_distance() that is as long as the path in the same time, Hz (MFREQ).
[[nodiscard]] double mean_frequency(const math::SeriesMatrix& x, double duration_s);

}  // namespace kinemark::analysis
