// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// How strongly to smooth: order and cut-off of least expected error, and the noise that the samples show.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/noise_model.h"

namespace kinemark::math {

/// Order and cut-off of a DifferenceSmoother, common to all series, so that the choice does not depend on how
/// the axes of the laboratory stand.
struct SmoothingChoice {
  int order = 3;             ///< m
  double half_power = kNaN;  ///< cycles per sample
  double risk = kNaN;        ///< expected squared error of a smoothed sample over the noise variance
  double parameters = kNaN;  ///< trace of the smoother: free numbers of the samples judged, per series
};

/// Which orders and cut-offs are tried.
struct SmoothingSearch {
  std::vector<int> orders{3, 4, 5};  ///< 1 to 5 each
  double lowest = 0.0;               ///< lowest half-power frequency, cycles per sample, above 0
  double highest = 0.45;             ///< highest, below 0.5
  int frequencies = 13;              ///< tried between them at equal ratios, then four around the best
  /// of longer series as many, in four stretches from the first to the last sample, long ones because at an
  /// end less can be smoothed away: at least 4000
  std::int64_t samples = 16384;
  /// Noise that is not white, in the unit of the series; null: white of variance 1. The trace is then that of
  /// the smoother times the noise's covariance, by its spectrum.
  const NoiseModel* noise = nullptr;
};

/// The order and cut-off of least expected error by Stein's unbiased estimate (SURE: residual sum of squares
/// plus twice the trace of the smoother, Stein 1981; Craven & Wahba 1979), for white noise or that of the
/// search.
///
/// @param series  n samples of some axes, over the standard deviation of their noise
/// @return        nothing where no order has samples enough, or none can be computed in double precision.
/// Cost: about 60 factors of a DifferenceSmoother for each order, of search.samples samples at most.
[[nodiscard]] std::optional<SmoothingChoice> choose_smoothing(const SeriesMatrix& series,
                                                              const std::vector<bool>& seen,
                                                              const SmoothingSearch& search);

/// Standard deviation of white noise, from the sixth differences of stretches without missing samples: a path
/// that is smooth from sample to sample has next to none of them. Columns pooled; NaN where no seven samples
/// follow each other. Too large where the movement itself reaches near half the sampling rate.
[[nodiscard]] double noise_from_differences(const SeriesMatrix& series, const std::vector<bool>& seen);

}  // namespace kinemark::math
