// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

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

}  // namespace kinemark::trajectory::smoothing
