// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The frequency of a movement that repeats, by a fundamental and its harmonics that are fitted together with
// the trend. A periodogram's peak is off by what leaks into it from the trend, from other harmonics and,
// where cycles are not whole, from its own mirror image: by many times what noise does.
#pragma once

#include <cstdint>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// What is fitted, settled once for all versions of a path.
struct HarmonicForm {
  double fundamental_hz = kNaN;  ///< to start from; NaN: nothing is fitted
  int dominant = 1;              ///< which of its multiples is the dominant frequency
  int count = 0;                 ///< multiples that are fitted, from the first on
  int trend = 1;                 ///< degree of the polynomial, 1 to 3
};

/// The form of a movement with this dominant frequency, about: with one multiple for each half of the
/// fundamental's samples at most, and a fundamental that is a half or a third of the dominant frequency where
/// this leaves a third of the squares.
/// @param x        n x 3
/// @param peak_hz  of the periodogram; NaN: none
[[nodiscard]] HarmonicForm harmonic_form(const PathMatrix& x, double rate_hz, double peak_hz);

/// A path's dominant frequency.
struct HarmonicFit {
  double dominant_hz = kNaN;  ///< NaN: not determined
  /// Square of the deviation by which it is open where cycles differ, Hz^2: noise counts as well.
  double wander = kNaN;
};

/// Least squares of trend and harmonics, the frequency by Gauss and Newton. Where phases depart by more than
/// a radian from an even movement, the line of least squares through them; none where that is off by a tenth.
/// Cost: n times the square of the number of multiples, a few times; of long series means over some samples
/// are fitted.
[[nodiscard]] HarmonicFit fit_harmonics(const PathMatrix& x, double rate_hz, const HarmonicForm& form);

}  // namespace kinemark::analysis
