// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Samples of one marker, taken out of the trajectories.
struct MarkerSamples {
  std::int64_t frames = 0, measured = 0;
  double interval_s = 0.0;
  Array<double> x;              ///< F x 3, m
  Array<std::uint8_t> present;  ///< F: coordinates, from wherever
  Array<std::uint8_t> judged;   ///< F: coordinates that choose the filter: measured, or all if too few are
  bool has_covariance = false;  ///< the recording brought variances
  bool same_for_all_axes = true;
  double typical_sd_m = 0.0;  ///< root of the median variance; 0 without covariance
  Array<double> variance;     ///< 3 x F (axis first), relative to the median; empty when all are 1
  Array<double> time_s;       ///< F; empty when samples are even
  std::int64_t bad_variances = 0;

  /// One series of three axes, or three of one axis where variances differ.
  /// @param y  receives the axis-wise copies that these series borrow; unused for one series
  [[nodiscard]] std::vector<Series> series(const Array<std::uint8_t>& seen,
                                           std::vector<Array<double>>& y) const;
};

/// A sample that an earlier stage made shares its errors with its neighbours: a stretch of n such samples has
/// n times the variance each, so that it counts as one. Fails when a marker's times do not rise.
[[nodiscard]] Result<MarkerSamples> marker_samples(const data::Trajectories& in, std::int64_t marker);

/// Frames [begin, end) without a gap.
struct Stretch {
  std::int64_t begin = 0, end = 0;
  [[nodiscard]] std::int64_t length() const { return end - begin; }
};

/// Longest runs of frames that are present, in order.
[[nodiscard]] std::vector<Stretch> stretches(const Array<std::uint8_t>& present);

/// Stretches for choosing a filter: all of them up to 16384 frames in sum, else an even choice of that many.
[[nodiscard]] std::vector<Stretch> sample_of(const std::vector<Stretch>& all);

/// Axis of a stretch as a column.
[[nodiscard]] std::vector<double> column(const Array<double>& x, const Stretch& stretch, int axis);

/// Two-point differences: central inside, one-sided at both ends; NaN for a single value. O(n).
[[nodiscard]] std::vector<double> differences(const std::vector<double>& x, double interval_s);

/// |central difference|^2 of a frequency in units of the rate, s^-2.
[[nodiscard]] double difference_power(double frequency, double interval_s);

/// Butterworth, classic and none. Standard deviations contain the noise that passes the filter, not the
/// movement that it removes. Fails with not_supported when the marker's samples are not evenly spaced.
[[nodiscard]] Status smooth_butterworth(const MarkerSamples& samples, const SmoothOptions& options,
                                        double rate_hz, MarkerResult& result);

/// Local polynomials. Ends of a stretch are the end of its first and last whole window; a stretch shorter
/// than the window is one polynomial. Fails as smooth_butterworth().
[[nodiscard]] Status smooth_savgol(const MarkerSamples& samples, const SmoothOptions& options, double rate_hz,
                                   MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
