// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

namespace kinemark::io {

/// A polynomial in place of a function.
struct PolynomialFit {
  std::vector<double> coefficients;  ///< from the constant upwards
  double largest_error = 0.0;        ///< over the range, in the unit of the function

  /// The polynomial at x.
  [[nodiscard]] double operator()(double x) const;
};

/// The polynomial of that degree nearest to a function over low <= x <= high, by least squares at Chebyshev's
/// points, which keeps the largest error near the least possible. low < high, degree >= 0. The error is
/// looked for at 1,001 points.
[[nodiscard]] PolynomialFit fit_polynomial(const std::function<double(double)>& function, double low,
                                           double high, int degree);

}  // namespace kinemark::io
