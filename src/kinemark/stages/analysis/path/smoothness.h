// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// How smooth a movement was. All are negative; nearer to 0 is smoother.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// Length of the arc of the speed's amplitude spectrum.
struct SpectralArc {
  double value = kNaN;    ///< SPARC; NaN of fewer than two frequencies beyond the threshold
  double last_hz = kNaN;  ///< highest frequency beyond the threshold: where the arc ends
};
/// SPARC (Balasubramanian, Melendez-Calderon, Roby-Brami & Burdet 2015): spectrum on 2^(ceil(log2 n) + 4)
/// frequencies, over its largest value, up to 10 Hz, from the first to the last value of 0.05 or more. It
/// depends on n over the transform's length: compare values of equal rate and duration.
/// @param speed  n values of at least 0, m/s, at least two
[[nodiscard]] SpectralArc spectral_arc(const Eigen::VectorXd& speed, double rate_hz);

/// Log dimensionless jerk of positions: -ln(T^3 / v_peak^2 integral |jerk|^2 dt), T = (n - 1) / rate,
/// trapezoids (Balasubramanian et al. 2015, table 3). -5.322033893165 of a minimum-jerk reach.
[[nodiscard]] double log_dimensionless_jerk(const PathSamples& path);

/// The same of a speed profile, as its authors' program computes it: T = n / rate, second differences of the
/// speed, rectangles. It differs from that of positions: a circle at constant speed has none.
[[nodiscard]] double log_dimensionless_jerk_of_speed(const Eigen::VectorXd& speed, double rate_hz);

/// Root of the mean squared jerk, m/s^3.
[[nodiscard]] double rms_jerk(const PathSamples& path);

}  // namespace kinemark::analysis
