// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The smoothing spline without a filter, all samples at once: what fast ones are judged by.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace kinemark::testing_support {

/// Estimate of a polynomial plus an m-times integrated Wiener process seen in noise, which is also the spline
/// of half order m: residual = R M y with M = Z (Z' (q K + R) Z)^-1 Z', Z a base of what no polynomial of
/// degree m - 1 reaches. Wahba (1990), Spline Models for Observational Data, section 1.3. Some 60 samples
/// over some 50 / corner at most: the covariance of the process grows as (corner t)^(2m - 1).
struct DenseSpline {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  std::vector<double> smooth, variance;  ///< at the samples
  double rss = 0.0;                      ///< squared residuals over their variances
  double trace = 0.0;                    ///< of the matrix from samples to smoothed samples

  /// @param t  rising, >= 0   @param r  noise variances   @param q  spectral density of the m-th derivative
  DenseSpline(const std::vector<double>& t, const std::vector<double>& y, const std::vector<double>& r, int m,
              double q) {
    const auto n = static_cast<Eigen::Index>(t.size());
    Matrix cov(n, n), poly(n, m);
    Vector value(n), noise(n);
    Real factorial = 1;
    for (int k = 2; k < m; ++k) factorial *= k;
    for (Eigen::Index i = 0; i < n; ++i) {
      value(i) = y[static_cast<std::size_t>(i)];
      noise(i) = r[static_cast<std::size_t>(i)];
      for (int p = 0; p < m; ++p) poly(i, p) = std::pow(static_cast<Real>(t[static_cast<std::size_t>(i)]), p);
      for (Eigen::Index j = 0; j < n; ++j) {
        // integral from 0 to a of (a - u)^(m-1) (b - u)^(m-1) du, a <= b, by the binomial theorem about a
        const Real a = std::min(t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>(j)]);
        const Real b = std::max(t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>(j)]);
        Real sum = 0, choose = 1;
        for (int k = 0; k < m; ++k) {
          sum += choose * std::pow(b - a, m - 1 - k) * std::pow(a, m + k) / (m + k);
          choose = choose * (m - 1 - k) / (k + 1);
        }
        cov(i, j) = q * sum / (factorial * factorial);
      }
    }
    cov.diagonal() += noise;
    const Eigen::HouseholderQR<Matrix> qr(poly);
    const Matrix z = (qr.householderQ() * Matrix::Identity(n, n)).rightCols(n - m);
    const Matrix full = z * (z.transpose() * cov * z).ldlt().solve(z.transpose());
    const Vector residual = noise.cwiseProduct(full * value);
    for (Eigen::Index i = 0; i < n; ++i) {
      smooth.push_back(static_cast<double>(value(i) - residual(i)));
      variance.push_back(static_cast<double>(noise(i) - noise(i) * full(i, i) * noise(i)));
    }
    rss = static_cast<double>(residual.cwiseAbs2().cwiseQuotient(noise).sum());
    trace = static_cast<double>(static_cast<Real>(n) - noise.dot(full.diagonal()));
  }

  /// Woltring's criterion (GCVSPL): (RSS / n) / (1 - trace / n)^2.
  [[nodiscard]] double gcv() const {
    const auto n = static_cast<double>(smooth.size());
    return rss / n / std::pow(1.0 - trace / n, 2);
  }
};

}  // namespace kinemark::testing_support
