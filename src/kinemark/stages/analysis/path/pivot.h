// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From what noise does to a measure, to its value without bias and its interval.
#pragma once

#include <span>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {

/// A value without its bias, and where the truth lies.
struct Pivoted {
  double value = kNaN;  ///< the estimate less the mean deviation
  double sd = kNaN;     ///< of the deviations
  double low = kNaN;    ///< the estimate less the upper quantile of the deviations
  double high = kNaN;   ///< the estimate less the lower quantile
};

/// The pivot of an estimate: deviations of refits from what they were made of stand for its own deviation
/// from the truth. Quantiles at (S + 1) p of S deviations, exact for exchangeable ones (Weibull).
/// @param deviations  values of refits less the value of their path; NaN (a measure that a refit does not
/// determine)
///                    is left out, and nothing is said where more than a tenth are
[[nodiscard]] Pivoted pivot(double estimate, std::span<const double> deviations, double level);

/// The pivot with the wider of its ends and those of the percentile interval [estimate + lower quantile,
/// estimate + upper quantile]: where deviations are lopsided, as those of an instant that jumps, the pivot
/// alone fails.
[[nodiscard]] Pivoted wide_pivot(double estimate, std::span<const double> deviations, double level);
/// pivot_of_square() likewise.
[[nodiscard]] Pivoted wide_pivot_of_square(double estimate, std::span<const double> deviations, double level);

/// The same for a measure that is a root of a mean of squares, on the squares, where noise adds a constant.
/// @param deviations  differences of squares
/// @return  value and ends as roots; sd to first order, NaN at 0. A square below 0 is moved to 0, its upper
///          end with it, which stays above 0 as far as refits spread: 0 is no finding
[[nodiscard]] Pivoted pivot_of_square(double estimate, std::span<const double> deviations, double level);

}  // namespace kinemark::analysis
