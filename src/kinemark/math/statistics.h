// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Order statistics. All take their values in any order and leave them as they are; NaN of no values, and NaN
// where one of the values is: what is missing is taken out by the caller, who knows why. O(n) time, one copy.
#pragma once

#include <cstddef>
#include <span>

namespace kinemark::math {

/// @param rank  0 for the smallest, below the number of values unless there are none
/// @return      the value at `rank` in ascending order
[[nodiscard]] double nth_smallest(std::span<const double> values, std::size_t rank);

/// The middle value; the mean of the two middle ones where their number is even.
[[nodiscard]] double median(std::span<const double> values);

/// The middle value; the larger of the two middle ones where their number is even: always one of the values.
[[nodiscard]] double upper_median(std::span<const double> values);

/// @param share  0 to 1: of the values, those below the result
/// @return       the value at rank share (n - 1), rounded: always one of the values
[[nodiscard]] double quantile(std::span<const double> values, double share);

}  // namespace kinemark::math
