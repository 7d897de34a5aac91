// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/polynomial_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"

namespace kinemark::io {
namespace {

constexpr int kFitted = 201, kChecked = 1001;

/// Coefficients in x of a polynomial in (x - middle) / half, by Horner's rule on polynomials.
std::vector<double> unscaled(const Eigen::VectorXd& scaled, double middle, double half) {
  std::vector<double> out{0.0};
  for (Eigen::Index k = scaled.size() - 1; k >= 0; --k) {
    std::vector<double> next(out.size() + 1, 0.0);
    for (std::size_t i = 0; i < out.size(); ++i) {
      next[i] -= out[i] * middle / half;
      next[i + 1] += out[i] / half;
    }
    next[0] += scaled[k];
    out = std::move(next);
  }
  out.resize(at(static_cast<int>(scaled.size())));
  return out;
}

}  // namespace

double PolynomialFit::operator()(double x) const {
  double sum = 0.0;
  for (const double c : std::views::reverse(coefficients)) sum = sum * x + c;
  return sum;
}

PolynomialFit fit_polynomial(const std::function<double(double)>& function, double low, double high,
                             int degree) {
  check(low < high && degree >= 0, "fit_polynomial() needs low < high and a degree of 0 or more");
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  Eigen::MatrixXd powers(kFitted, degree + 1);
  Eigen::VectorXd values(kFitted);
  for (int i = 0; i < kFitted; ++i) {
    const double s = std::cos(std::numbers::pi * (i + 0.5) / kFitted);
    values[i] = function(middle + half * s);
    powers(i, 0) = 1.0;
    for (int k = 1; k <= degree; ++k) powers(i, k) = powers(i, k - 1) * s;
  }
  PolynomialFit fit{.coefficients = unscaled(powers.colPivHouseholderQr().solve(values), middle, half)};
  for (int i = 0; i < kChecked; ++i) {
    const double x = low + (high - low) * i / (kChecked - 1);
    fit.largest_error = std::max(fit.largest_error, std::abs(fit(x) - function(x)));
  }
  return fit;
}

}  // namespace kinemark::io
