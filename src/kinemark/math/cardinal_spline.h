// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What smoothing splines of evenly spaced samples are made of: differences, and the B-spline at the integers.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"

namespace kinemark::math {

/// Coefficients of the m-th difference, that of the latest sample last: (1, -2, 1) for m = 2.
[[nodiscard]] inline std::vector<double> difference_coefficients(int order) {
  std::vector<double> c{1.0};
  for (int m = 0; m < order; ++m) {
    c.push_back(0.0);
    for (std::size_t i = c.size() - 1; i > 0; --i) c[i] = c[i - 1] - c[i];
    c[0] = -c[0];
  }
  return c;
}

/// The cardinal B-spline of order 2m at the integers `lag` away from its middle, lag 0 to m - 1. By the
/// recurrence in the order, from the hat function of order 2 at integers and halves alike: exact fractions.
[[nodiscard]] inline std::vector<double> spline_at_integers(int order) {
  const int degree = 2 * order - 1;
  // values[k]: of the spline of the present order at k (k = 1 .. order - 1).
  std::vector<double> values{0.0, 1.0};
  for (int d = 2; d <= degree; ++d) {  // from degree d - 1 (order d) to degree d (order d + 1)
    std::vector<double> next(at(d + 1), 0.0);
    for (int k = 1; k <= d; ++k) {
      const double here = k < static_cast<int>(values.size()) ? values[at(k)] : 0.0;
      next[at(k)] = (k * here + (d + 1 - k) * values[at(k - 1)]) / d;
    }
    values = std::move(next);
  }
  std::vector<double> out;
  for (int lag = 0; lag < order; ++lag) out.push_back(values[at(order + lag)]);
  return out;
}

}  // namespace kinemark::math
