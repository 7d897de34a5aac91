// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "kinemark/math/wiener_smoother.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

namespace kinemark::trajectory {

/// One observation of a point in space: position and inverse covariance (singular where only one camera saw
/// it, zero where none did).
using LedObservation = math::PositionObservation<3>;

/// The smoother with this `order` and half-gain frequency, for samples of inverse variance
/// `information` (m^-2 per axis) `interval_s` apart: q = omega0^(2 order) interval / information.
[[nodiscard]] Bandwidth bandwidth_at(int order, double half_gain_hz, double information, double interval_s);

/// Options of the choice of a bandwidth.
struct BandwidthOptions {
  int order = 0;              ///< 3, 4 or 5; 0: the best of them
  double half_gain_hz = 0.0;  ///< 0: the best
  double around_hz = 0.0;     ///< half gain: search only within two octaves around it; 0: everywhere
  /// Squares (z - x)' h (z - x) on one axis of one observation that count at most, against outliers; above 0.
  double most_squares = std::numeric_limits<double>::infinity();
  std::size_t max_observations = 1200;  ///< records longer than that are judged by four pieces of them
};

/// Order and bandwidth with the least estimated risk (Stein's unbiased estimate with known covariances):
/// sum (z - x)' H (z - x) + 2 tr(P H), over the observations that fix all three coordinates.
///
/// Falls back to a 6 Hz filter of order 4 when fewer than 12 observations are complete. Cost: about 50
/// filters over min(F, max_observations) observations. Stein (1981), Ann. Stat. 9:1135; Craven & Wahba
/// (1979), Numer. Math. 31:377.
[[nodiscard]] Bandwidth choose_bandwidth(std::span<const LedObservation> observations,
                                         const BandwidthOptions& options = {});

}  // namespace kinemark::trajectory
