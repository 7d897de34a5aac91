// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/spline_undo.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/cardinal_spline.h"

namespace kinemark::math {
namespace {

constexpr std::int64_t kMostNumbers = 20'000'000;

/// B of n rows, factored as L D L': a band of m - 1 below the diagonal.
class SplineBand {
 public:
  SplineBand(std::int64_t n, int order) : n_(n), width_(order - 1), l_(at(n * order)) {
    const std::vector<double> spline = spline_at_integers(order);
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t lag = std::min(width_, i); lag >= 0; --lag) {
        const std::int64_t j = i - lag;
        double value = spline[at(lag)];
        for (std::int64_t k = std::max<std::int64_t>(0, i - width_); k < j; ++k)
          if (j - k <= width_) value -= l(i, k) * l(j, k) * l(k, k);
        l(i, j) = lag == 0 ? value : value / l(j, j);
        sound_ = sound_ && std::isfinite(value) && (lag > 0 || value > 0.0);
      }
  }
  [[nodiscard]] bool sound() const { return sound_; }

  void solve(SeriesMatrix& x) const {
    for (std::int64_t i = 0; i < n_; ++i)
      for (std::int64_t k = std::max<std::int64_t>(0, i - width_); k < i; ++k) x.row(i) -= l(i, k) * x.row(k);
    for (std::int64_t i = n_ - 1; i >= 0; --i) {
      x.row(i) /= l(i, i);
      for (std::int64_t k = i + 1; k <= std::min(n_ - 1, i + width_); ++k) x.row(i) -= l(k, i) * x.row(k);
    }
  }

 private:
  [[nodiscard]] double& l(std::int64_t i, std::int64_t j) { return l_[at(i * (width_ + 1) + i - j)]; }
  [[nodiscard]] double l(std::int64_t i, std::int64_t j) const { return l_[at(i * (width_ + 1) + i - j)]; }

  std::int64_t n_, width_;
  std::vector<double> l_;  ///< row i: columns i, i - 1, ...; D on the diagonal
  bool sound_ = true;
};

/// Rows that were not seen on straight lines between their neighbours: any values would do, these keep
/// digits.
void bridge(SeriesMatrix& x, const std::vector<bool>& seen) {
  const auto n = static_cast<std::int64_t>(seen.size());
  std::int64_t before = -1;
  for (std::int64_t i = 0; i <= n; ++i) {
    if (i < n && !seen[at(i)]) continue;
    for (std::int64_t k = before + 1; k < i; ++k) {
      if (before < 0)
        x.row(k) = x.row(i);
      else if (i == n)
        x.row(k) = x.row(before);
      else
        x.row(k) = x.row(before) + (x.row(i) - x.row(before)) *
                                       (static_cast<double>(k - before) / static_cast<double>(i - before));
    }
    before = i;
  }
}

}  // namespace

double half_power_of(int order, double cutoff_hz, double rate_hz) {
  return cutoff_hz / rate_hz / std::pow(std::numbers::sqrt2 - 1.0, 1.0 / (2.0 * order));
}

double undo_gain(int order, double half_power) {
  constexpr int kFrequencies = 1024;
  const std::vector<double> spline = spline_at_integers(order);
  const double r = std::exp(DifferenceSmoother::log_intensity(order, half_power));
  double sum = 0.0;
  for (int k = 0; k < kFrequencies; ++k) {
    const double w = std::numbers::pi * (k + 0.5) / kFrequencies;
    double b = spline[0];
    for (int lag = 1; lag < order; ++lag) b += 2.0 * spline[at(lag)] * std::cos(lag * w);
    const double gain = 1.0 + std::pow(2.0 * std::sin(0.5 * w), 2 * order) / (r * b);
    sum += gain * gain / kFrequencies;
  }
  return std::sqrt(sum);
}

std::optional<UndoneSpline> undo_spline(const SeriesMatrix& smoothed, const std::vector<bool>& seen,
                                        int order, double half_power, double rounding_sd) {
  check(order >= 1 && order <= 5, "the order of a smoother is 1 to 5");
  check(half_power > 0.0 && rounding_sd >= 0.0, "a half-power frequency is above 0, a rounding not below");
  check(smoothed.rows() == static_cast<std::int64_t>(seen.size()), "a flag for each row");
  const std::int64_t n = smoothed.rows(), m = order, columns = smoothed.cols();
  std::vector<std::int64_t> gaps;
  for (std::int64_t i = 0; i < n; ++i)
    if (!seen[at(i)]) gaps.push_back(i);
  const auto g = std::ssize(gaps);
  check(n - g > m, "a smoother needs more samples than its order");
  if (n * g > kMostNumbers) return std::nullopt;

  SeriesMatrix f = smoothed;
  bridge(f, seen);
  const Eigen::RowVectorXd level = f.colwise().mean();
  const double largest = f.cwiseAbs().maxCoeff();
  f.rowwise() -= level;
  const std::vector<double> difference = difference_coefficients(order);
  const SplineBand band(n - m, order);
  if (!band.sound() || !f.allFinite()) return std::nullopt;

  // r gamma = B^-1 (D f - D_g l), and D_g' gamma = 0 gives l.
  SeriesMatrix gamma = SeriesMatrix::Zero(n - m, columns);
  for (std::int64_t i = 0; i < n - m; ++i)
    for (std::int64_t k = 0; k <= m; ++k) gamma.row(i) += difference[at(k)] * f.row(i + k);
  band.solve(gamma);
  if (g > 0) {
    SeriesMatrix of_gap = SeriesMatrix::Zero(n - m, g);  // D_g, then B^-1 D_g
    for (std::int64_t c = 0; c < g; ++c)
      for (std::int64_t k = 0; k <= m; ++k)
        if (const std::int64_t i = gaps[at(c)] - k; i >= 0 && i < n - m) of_gap(i, c) = difference[at(k)];
    const SeriesMatrix touched = of_gap;
    band.solve(of_gap);
    const Eigen::LDLT<Eigen::MatrixXd> square(Eigen::MatrixXd(touched.transpose() * of_gap));
    if (square.info() != Eigen::Success) return std::nullopt;
    const Eigen::MatrixXd right = touched.transpose() * gamma, left_out = square.solve(right);
    gamma -= of_gap * left_out;
  }

  const double r = std::exp(DifferenceSmoother::log_intensity(order, half_power));
  UndoneSpline out{.samples = std::move(f), .error_sd = 0.0};
  for (std::int64_t i = 0; i < n - m; ++i)
    for (std::int64_t k = 0; k <= m; ++k) out.samples.row(i + k) += difference[at(k)] / r * gamma.row(i);
  out.samples.rowwise() += level;
  for (const std::int64_t i : gaps) out.samples.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  const double own = std::numeric_limits<double>::epsilon() * largest / std::sqrt(12.0);
  out.error_sd = undo_gain(order, half_power) * std::max(rounding_sd, own);
  return std::isfinite(out.error_sd) ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace kinemark::math
