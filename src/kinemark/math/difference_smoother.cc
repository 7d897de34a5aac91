// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/difference_smoother.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"

namespace kinemark::math {
namespace {

// Coefficients of the m-th difference, that of the latest sample last: (1, -2, 1) for m = 2.
std::vector<double> difference_coefficients(int order) {
  std::vector<double> c{1.0};
  for (int m = 0; m < order; ++m) {
    c.push_back(0.0);
    for (std::size_t i = c.size() - 1; i > 0; --i) c[i] = c[i - 1] - c[i];
    c[0] = -c[0];
  }
  return c;
}

// The cardinal B-spline of order 2m at the integers `lag` away from its middle, lag 0 to m - 1. By the
// recurrence in the order, from the hat function of order 2 at integers and halves alike: exact fractions.
std::vector<double> spline_at_integers(int order) {
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

// Missing samples by straight lines between their neighbours, flat at the ends: any values would do, these
// keep the digits.
void fill_straight(const std::vector<bool>& seen, SeriesMatrix& series) {
  const auto n = static_cast<std::int64_t>(seen.size());
  std::int64_t before = -1;
  for (std::int64_t i = 0; i <= n; ++i) {
    if (i < n && !seen[at(i)]) continue;
    for (std::int64_t k = before + 1; k < i; ++k) {
      if (before < 0)
        series.row(k) = series.row(i);
      else if (i == n)
        series.row(k) = series.row(before);
      else
        series.row(k) =
            series.row(before) + (series.row(i) - series.row(before)) *
                                     (static_cast<double>(k - before) / static_cast<double>(i - before));
    }
    before = i;
  }
}

}  // namespace

double DifferenceSmoother::log_intensity(int order, double half_power) {
  return 2.0 * order * std::log(2.0 * std::numbers::pi * half_power);
}

DifferenceSmoother::DifferenceSmoother(std::vector<bool> seen, int order)
    : seen_(std::move(seen)),
      order_(order),
      difference_(difference_coefficients(order)),
      spline_(spline_at_integers(order)) {
  check(order >= 1 && order <= 5, "the order of a smoother is 1 to 5");
  check(std::ranges::count(seen_, true) > order, "a smoother needs more samples than its order");
  const std::int64_t n = samples(), m = order_;
  gamma_row_.resize(at(n - m));
  gap_row_.assign(at(n), -1);
  for (std::int64_t i = 0; i < n; ++i) {  // the sample's difference, then the sample if it is missing
    if (i < n - m) gamma_row_[at(i)] = unknowns_++;
    if (!seen_[at(i)]) gap_row_[at(i)] = unknowns_++;
  }
  for (std::int64_t i = 0; i < n - m; ++i) {
    const std::int64_t row = gamma_row_[at(i)];
    width_ = std::max(width_, row - gamma_row_[at(std::max<std::int64_t>(0, i - m))]);
    for (std::int64_t k = 0; k <= m; ++k) {
      const std::int64_t gap = gap_row_[at(i + k)];
      if (gap >= 0) width_ = std::max(width_, std::abs(gap - row));
    }
  }
}

void DifferenceSmoother::assemble(double intensity) {
  const std::int64_t n = samples(), m = order_;
  factor_.assign(at(unknowns_ * (width_ + 1)), 0.0);
  for (std::int64_t i = 0; i < n - m; ++i) {
    for (std::int64_t lag = 0; lag <= std::min(m, i); ++lag) {
      double value = lag < m ? intensity * spline_[at(lag)] : 0.0;
      for (std::int64_t k = 0; k + lag <= m; ++k)  // samples that both differences hold
        if (seen_[at(i + k)]) value += difference_[at(k)] * difference_[at(k + lag)];
      band(gamma_row_[at(i)], gamma_row_[at(i - lag)]) = value;
    }
    for (std::int64_t k = 0; k <= m; ++k)
      if (const std::int64_t gap = gap_row_[at(i + k)]; gap >= 0) {
        const std::int64_t row = gamma_row_[at(i)];
        band(std::max(gap, row), std::min(gap, row)) = difference_[at(k)];
      }
  }
}

bool DifferenceSmoother::factor(double half_power) {
  const double log_r = log_intensity(order_, half_power);
  // Below this the smallest eigenvalue of D D' + r B is lost in rounding (measured: docs/theory/measures.md).
  if (!(log_r > std::log(1e-12))) return false;
  assemble(std::exp(log_r));
  log_determinant_ = 0.0;
  std::vector<double> scaled(at(width_ + 1));  // L D of the row in hand
  for (std::int64_t row = 0; row < unknowns_; ++row) {
    const std::int64_t first = std::max<std::int64_t>(0, row - width_);
    double pivot = band(row, row);
    for (std::int64_t column = first; column < row; ++column) {
      double value = band(row, column);
      for (std::int64_t k = std::max(first, column - width_); k < column; ++k)
        value -= band(column, k) * scaled[at(k - first)];
      scaled[at(column - first)] = value;
      band(row, column) = value / band(column, column);
      pivot -= band(row, column) * value;
    }
    if (pivot == 0.0 || !std::isfinite(pivot)) return false;
    band(row, row) = pivot;
    log_determinant_ += std::log(std::abs(pivot));
  }
  return true;
}

void DifferenceSmoother::smooth(SeriesMatrix& series) const {
  const std::int64_t n = samples(), m = order_;
  check(series.rows() == n, "a smoother takes series of its own length");
  // Row by row, so that a column's digits do not depend on those beside it.
  Eigen::RowVectorXd level = Eigen::RowVectorXd::Zero(series.cols());
  for (std::int64_t i = 0; i < n; ++i)
    if (seen_[at(i)]) level += series.row(i);
  level /= static_cast<double>(std::ranges::count(seen_, true));
  series.rowwise() -= level;
  fill_straight(seen_, series);
  SeriesMatrix unknown = SeriesMatrix::Zero(unknowns_, series.cols());
  for (std::int64_t i = 0; i < n - m; ++i)
    for (std::int64_t k = 0; k <= m; ++k)
      unknown.row(gamma_row_[at(i)]) += difference_[at(k)] * series.row(i + k);
  for (std::int64_t row = 0; row < unknowns_; ++row)
    for (std::int64_t column = std::max<std::int64_t>(0, row - width_); column < row; ++column)
      if (const double l = band(row, column); l != 0.0) unknown.row(row) -= l * unknown.row(column);
  for (std::int64_t row = unknowns_ - 1; row >= 0; --row) {
    // Rows below have taken their part of this one already.
    unknown.row(row) /= band(row, row);
    for (std::int64_t below = row + 1; below <= std::min(unknowns_ - 1, row + width_); ++below)
      if (const double l = band(below, row); l != 0.0) unknown.row(row) -= l * unknown.row(below);
  }
  for (std::int64_t i = 0; i < n; ++i) {
    if (const std::int64_t gap = gap_row_[at(i)]; gap >= 0) {
      series.row(i) -= unknown.row(gap);
      continue;
    }
    for (std::int64_t k = std::max<std::int64_t>(0, i - (n - m - 1)); k <= std::min(m, i); ++k)
      series.row(i) -= difference_[at(k)] * unknown.row(gamma_row_[at(i - k)]);
  }
  series.rowwise() += level;
}

}  // namespace kinemark::math
