// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Smallest value of a function of one variable without derivatives. Kiefer (1953), Proc. Am. Math. Soc.
// 4:502.
#pragma once

#include <limits>
#include <numbers>

namespace kinemark::math {

/// When to stop: whichever comes first.
struct GoldenSectionStop {
  double width = 0.0;                              ///< of the interval, in the unit of the variable
  int sections = std::numeric_limits<int>::max();  ///< at least one of the two must be given
};

/// What golden_section() is left with.
struct GoldenSection {
  double low = 0.0, high = 0.0;  ///< what is left of the interval
  double at = 0.0, value = 0.0;  ///< the smallest value seen, the first of equal ones

  /// Of the interval that is left.
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// Shortens [low, high] by the golden ratio around the smaller of two inner values until `stop`.
///
/// A function with one minimum in the interval keeps it in the interval; of several, one is found. Values at
/// the ends are never asked for. Where `f` gives NaN, the lower part goes.
/// Calls `f` twice and once more for each section.
template <class Function>
[[nodiscard]] GoldenSection golden_section(Function&& f, double low, double high, GoldenSectionStop stop) {
  constexpr double kRatio = std::numbers::phi - 1.0;
  GoldenSection out{.value = std::numeric_limits<double>::infinity()};
  const auto evaluate = [&](double x) {
    const double value = f(x);
    if (value < out.value) out.at = x, out.value = value;
    return value;
  };
  double left = high - kRatio * (high - low), right = low + kRatio * (high - low);
  double at_left = evaluate(left), at_right = evaluate(right);
  for (int i = 0; i < stop.sections && high - low > stop.width; ++i) {
    if (at_left < at_right) {
      high = right, right = left, at_right = at_left;
      left = high - kRatio * (high - low);
      at_left = evaluate(left);
    } else {
      low = left, left = right, at_left = at_right;
      right = low + kRatio * (high - low);
      at_right = evaluate(right);
    }
  }
  out.low = low, out.high = high;
  return out;
}

}  // namespace kinemark::math
