// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The mean of curves with bands that hold over the whole curve at once.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"

namespace kinemark::analysis {

/// The mean of N curves at P points, and two simultaneous bands around it.
struct MeanBand {
  std::int64_t curves = 0;   ///< N
  double level = 0.95;       ///< probability that a band holds at all points at once
  std::vector<double> mean;  ///< P; NaN where a curve is missing
  std::vector<double> sd;    ///< P, between curves, N - 1
  double factor = kNaN;  ///< half-width of the bands in standard errors, and in deviations of a further curve
  double arc_length = 0.0;      ///< of the residuals' path on the unit sphere, rad: 0 of curves of one shape
  std::int64_t not_tested = 0;  ///< points at which a curve is missing

  /// Half-width of the band that holds the population's mean curve, at a point.
  [[nodiscard]] double of_mean(std::size_t point) const;
  /// Half-width of the band that holds one further curve (a normative band), at a point.
  [[nodiscard]] double of_one(std::size_t point) const;
};

/// Mean and simultaneous bands of curves.
///
/// The factor c solves level = 1 - 2 (P(T > c) + arc_length / 2 pi (1 + c^2/v)^(-(v-1)/2)), v = N - 1: the
/// expected number of crossings of a t field (Worsley 1994; in one dimension Pataky 2016), with the length of
/// the path that the standardised residuals take on the unit sphere as measure of roughness (Sun & Loader
/// 1994), which need not be even along the curve; never more than Bonferroni's. Curves are taken as Gaussian.
/// For N below 5 the bands are wide and rest on that.
///
/// @param curves  at least 3 curves
/// @param level   above 0 and below 1; else Code::usage
/// @return        Code::bad_input of fewer curves. Cost: N P.
[[nodiscard]] Result<MeanBand> mean_band(const data::CycleCurves& curves, double level = 0.95);

}  // namespace kinemark::analysis
