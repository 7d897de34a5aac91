// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

namespace kinemark::report {

/// A range of one axis and where it lies on the picture.
struct PlotAxis {
  double low = std::numeric_limits<double>::infinity();    ///< of what is shown
  double high = -std::numeric_limits<double>::infinity();  ///< of what is shown
  double from = 0.0;                                       ///< pixels of low
  double to = 1.0;                                         ///< pixels of high
  bool logarithmic = false;                                ///< low and high are logarithms to the base 10

  /// Whether a value has a place: finite, and positive where logarithmic.
  [[nodiscard]] bool shows(double value) const;
  /// Widen the range; a value without a place is passed over.
  void include(double value);
  /// Once all is included: 4 % of room at both ends, 0 to 1 where nothing was.
  void settle();
  /// Pixels of a value.
  [[nodiscard]] double at(double value) const;
  /// Where grid lines go: 1, 2 or 5 times a power of ten, about `count` of them; twice that at most where
  /// logarithmic.
  [[nodiscard]] std::vector<double> ticks(double count = 6.0) const;
};

/// Widen the axis that shows fewer units per pixel, so that one unit is as long on both.
void make_equal(PlotAxis& x, PlotAxis& y);

}  // namespace kinemark::report
