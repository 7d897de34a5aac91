// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What went into a smoothing spline, from what came out: for files that tell the filter and hold smoothed
// samples in double precision, but not those from before.
#pragma once

#include <optional>
#include <vector>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::math {

/// What went into a smoothing spline.
struct UndoneSpline {
  SeriesMatrix samples;   ///< n x k, as `smoothed`; NaN where nothing was seen
  double error_sd = 0.0;  ///< of each of them, from the rounding of what was given; see undo_spline()
};

/// Undo DifferenceSmoother::smooth(), or any smoother of an m-times integrated Wiener process in white noise
/// of one variance at even times (data::FilterUsed::method "kalman" or "gcv" of complete stretches).
///
/// The smoothed samples are f = y - D'gamma with r B gamma = D f (Reinsch), so y = f + D' (r B)^-1 D f: one
/// banded solve. Samples that were missing are unknowns l more, from D_g' gamma = 0.
///
/// The undoing multiplies errors of f by (r B + |D|^2) / (r B) at each frequency: `error_sd` is the root mean
/// square of that gain over frequency times `rounding_sd`, or times the rounding of a double of the size of
/// the largest number in `smoothed` where that is more. It grows with the order and as the cut-off falls:
/// 600 mm at 100 Hz and 6 Hz leave 1e-9 mm of doubles for order 3, 4e-6 for 5; of single precision 0.5 mm
/// and 2 m. Use what comes out only where error_sd is small against the noise that went in.
///
/// @param smoothed     n x k; what stands in rows that were not seen does not count
/// @param seen         n flags, true where a sample went in; at least order + 1 of them
/// @param order        m, 1 to 5
/// @param half_power   frequency that the smoother halves, in cycles per sample, above 0: half_power_of()
/// @param rounding_sd  of the numbers in `smoothed`: step / sqrt(12); 0: that of doubles
/// @return nothing where the arithmetic fails, or where so many are missing that it would take more than 2e7
///         numbers. O(n m), and O(n m g + g^3) with g missing.
[[nodiscard]] std::optional<UndoneSpline> undo_spline(const SeriesMatrix& smoothed,
                                                      const std::vector<bool>& seen, int order,
                                                      double half_power, double rounding_sd = 0.0);

/// The root mean square over frequency of what undoing multiplies white errors by.
[[nodiscard]] double undo_gain(int order, double half_power);

/// The frequency that the smoother halves, in cycles per sample, of the -3 dB frequency that
/// data::FilterUsed tells.
[[nodiscard]] double half_power_of(int order, double cutoff_hz, double rate_hz);

}  // namespace kinemark::math
