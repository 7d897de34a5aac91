// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

namespace kinemark::trajectory::smoothing {

/// What correct_gaps() did.
struct GapCorrection {
  std::int64_t gaps = 0;     ///< that were corrected; 0: nothing was changed
  std::int64_t hidden = 0;   ///< stretches that were hidden to learn from, of the gap that has fewest
  double error_left = 1.0;   ///< RMS error of velocity in stretches left out of the learning, over that
                             ///< without correction; the largest of all corrected gaps
  std::vector<double> left;  ///< frames x 4: factor on the variance that a gap adds, by derivative; empty
                             ///< when nothing was changed
};

/// Correct smoothed values in gaps by what the recording shows of itself.
///
/// Between the samples beside a gap the integrated Wiener process goes the smoothest way; a movement that
/// repeats itself does not. Stretches like each gap (the same samples missing) are hidden elsewhere, and what
/// the smoother then misses, position and derivatives alike, is predicted by ridge regression from its
/// accelerations around the stretch. The ridge is that with the least error in stretches left out together
/// with all that overlap them; a gap is corrected only where that error is less than without.
/// Alike on all axes, so that results rotate with the laboratory. O(60 filters) for a short recording.
/// @param learn_from  samples to learn from, m, all axes of the marker
/// @param series      the samples that `state` was smoothed from, with the same filter
/// @param longest     gaps of more frames stay as they are
/// @param state       frames x axes x 4 of smooth_series(); changed
[[nodiscard]] GapCorrection correct_gaps(std::span<const Series> learn_from, const Series& series, int order,
                                         double cutoff_hz, std::int64_t longest, std::vector<double>& state);

}  // namespace kinemark::trajectory::smoothing
