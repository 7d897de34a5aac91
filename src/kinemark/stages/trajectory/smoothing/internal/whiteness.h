// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

namespace kinemark::trajectory::smoothing {

/// Verdict on a residual.
struct Whiteness {
  double p = kNaN;  ///< chance of so large a departure when the noise is white; NaN: it could not be judged
  /// Kolmogorov's distance: share of the noise power (0 to 1) that lies at other frequencies than that of
  /// white noise, > 0 where there is too much at low ones, < 0 where at high ones; NaN: it could not be
  /// judged
  double departure = kNaN;
  double lowest_hz = kNaN;  ///< the test looks at what lies between this and half the rate
};

/// Frames of the stretches that test_whiteness() compares, for an impulse response of the filter.
inline constexpr std::int64_t kWhitenessFrames = 256;

/// Test whether noise was white before a linear filter took its part of it away.
///
/// The residual of white noise is not white: the filter keeps the slow part. Its spectrum is the filter's
/// |1 - H|^2; divided by that, the periodogram of white noise is flat. Frequencies at which the filter takes
/// less than half the power are left out. Bartlett's test of the cumulative periodogram (Bartlett 1955;
/// Durbin 1969, Biometrika 56:1-15), pooled over axes and up to 32 stretches of 256 frames, each axis in
/// units of its own power; the p-value is Kolmogorov's with Stephens' correction.
///
/// @param residual  F x 3, any unit; NaN outside the stretches
/// @param usable    stretches without missing samples; one cut-off period at each end is left out, where
/// filters
///                  behave otherwise
/// @param impulse_response  of the filter, to a 1 in its middle; odd length
/// Could not be judged: fewer than 64 frames in every stretch, fewer than a tenth of the frequencies, or
/// eight, left, a residual that is zero.
[[nodiscard]] Whiteness test_whiteness(std::span<const double> residual, const std::vector<Stretch>& usable,
                                       std::span<const double> impulse_response, double cutoff_hz,
                                       double rate_hz);

}  // namespace kinemark::trajectory::smoothing
