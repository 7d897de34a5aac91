// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One number through time, its rate and its acceleration, with their covariance: the smoother of a single
// coordinate.
//
// Prior: third differences are white with SD s (a Wiener process of order three, seen through a grid that is
// fine against the motion). The precision matrix  A = D'D / s^2 + W  has three subdiagonals; its factor,
// log-determinant and the inverse within the band cost O(F). The ratio of s to the noise maximises the
// marginal likelihood (Wecker & Ansley 1983, J. Am. Stat. Assoc. 78:81), the noise itself follows from it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>

namespace kinemark::motion {

/// What is known about one coordinate. F frames.
struct SmoothedCoordinate {
  bool known = false;  ///< false: too few samples; value is the input, the rest 0, the covariance NaN
  Eigen::VectorXd value, rate, acceleration;  ///< F, unit of the input, per s, per s^2
  /// 6 x F: value-value, value-rate, value-acceleration, rate-rate, rate-acceleration,
  /// acceleration-acceleration.
  Eigen::MatrixXd covariance;
  double step_sd = 0.0;      ///< SD of a third difference, unit of the input
  double noise_scale = 0.0;  ///< estimated noise over the given sd (over 1 where none is given)
};

inline constexpr int kFewestSamples = 8;  ///< below it nothing is estimated

/// Smooth y (finite). `sd`: one standard deviation of each sample relative to the others; NaN: this sample
/// was not seen (y is then not used). An empty sd means equal samples. Gaps and both ends are bridged by the
/// prior, with growing variance. O(F), about 2 us per frame.
/// @param largest_noise_scale  > 0, bound of noise_scale: where the noise is known not to be above sd, what
/// is
///                             rough beyond it is motion
[[nodiscard]] SmoothedCoordinate smooth_coordinate(
    std::span<const double> y, std::span<const double> sd, double rate_hz,
    double largest_noise_scale = std::numeric_limits<double>::infinity());

/// What nearest_curve() finds.
struct NearestCurve {
  double step_variance = 0.0;  ///< of a third difference
  /// F, variance of the curve by what is not known of the step variance; 0 in recordings of more than 6000
  /// frames, where there is no doubt about it.
  Eigen::VectorXd spread;
};

/// Variance of a step where the noise is known: that of the curve which lies nearest to the truth, whatever
/// its spectrum. Mallows' C_p (1973, Technometrics 15:661) estimates the distance; bandwidths are averaged
/// with weights exp(-C_p / 4). A likelihood would take the variance from the lowest frequencies, of which
/// there are most that noise does not hide, and where a movement has less than white steps would have: it is
/// then too small where noise and movement meet. O(F), about 2 us per frame.
/// @param y        finite
/// @param weight   as long as y, the inverse variance of each sample's noise; 0: not seen
/// @param first    step variance from which the search begins; returned where fewer than 8 samples are seen
/// @param largest  >= 1, how often as large the variance of noise may be; above 1 it is found by its
/// likelihood
[[nodiscard]] NearestCurve nearest_curve(const Eigen::VectorXd& y, const Eigen::VectorXd& weight,
                                         double first, double largest = 1.0);

/// What curve_of() finds. F frames.
struct KnownCurve {
  Eigen::VectorXd value, variance;  ///< of each frame
};

/// Curve whose steps have a given variance, through samples with noise that is known, and its variance.
/// O(F).
/// @param y       finite, about zero: large offsets cost digits
/// @param weight  as long as y, the inverse variance of each sample's noise; 0: not seen; three at least are
/// seen
[[nodiscard]] KnownCurve curve_of(const Eigen::VectorXd& y, const Eigen::VectorXd& weight,
                                  double step_variance);

/// Rate and acceleration of an evenly sampled smooth number: five-point differences, at the ends continued
/// with a constant second difference. F >= 3.
void five_point_rates(const Eigen::VectorXd& y, double rate_hz, Eigen::VectorXd& rate,
                      Eigen::VectorXd& acceleration);

}  // namespace kinemark::motion
