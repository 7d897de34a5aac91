// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/difference_smoother.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/wide.h"

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
  find_envelope();
}

// Left of a row's first entry the factor has none either, so that a gap widens only the rows about it.
void DifferenceSmoother::find_envelope() {
  const std::int64_t n = samples(), m = order_;
  first_.resize(at(unknowns_));
  for (std::int64_t row = 0; row < unknowns_; ++row) first_[at(row)] = row;
  const auto touch = [this](std::int64_t row, std::int64_t column) {
    auto& first = first_[at(std::max(row, column))];
    first = std::min(first, std::min(row, column));
  };
  for (std::int64_t i = 0; i < n - m; ++i) {
    touch(gamma_row_[at(i)], gamma_row_[at(std::max<std::int64_t>(0, i - m))]);
    for (std::int64_t k = 0; k <= m; ++k)
      if (const std::int64_t gap = gap_row_[at(i + k)]; gap >= 0) touch(gamma_row_[at(i)], gap);
  }
  last_.resize(at(unknowns_));
  for (std::int64_t row = 0; row < unknowns_; ++row) {
    last_[at(row)] = row;
    for (std::int64_t column = first_[at(row)]; column < row; ++column) last_[at(column)] = row;
  }
}

void DifferenceSmoother::assemble(double intensity) {
  const std::int64_t n = samples(), m = order_;
  factor_.assign(at(unknowns_ * (width_ + 1)), 0.0);
  const auto entry = [&](std::int64_t i, std::int64_t lag, const auto& is_seen) {
    double value = lag < m ? intensity * spline_[at(lag)] : 0.0;
    for (std::int64_t k = 0; k + lag <= m; ++k)  // samples that both differences hold
      if (is_seen(i + k)) value += difference_[at(k)] * difference_[at(k + lag)];
    return value;
  };
  std::vector<double> complete;  // where all samples of a difference are seen
  for (std::int64_t lag = 0; lag <= m; ++lag)
    complete.push_back(entry(0, lag, [](std::int64_t) { return true; }));
  std::int64_t missing = 0;  // of the samples of the difference in hand
  for (std::int64_t k = 0; k < m; ++k) missing += !seen_[at(k)];
  for (std::int64_t i = 0; i < n - m; ++i) {
    missing += !seen_[at(i + m)];
    for (std::int64_t lag = 0; lag <= std::min(m, i); ++lag)
      band(gamma_row_[at(i)], gamma_row_[at(i - lag)]) =
          missing == 0 ? complete[at(lag)]
                       : entry(i, lag, [this](std::int64_t k) { return static_cast<bool>(seen_[at(k)]); });
    for (std::int64_t k = 0; missing > 0 && k <= m; ++k)
      if (const std::int64_t gap = gap_row_[at(i + k)]; gap >= 0) {
        const std::int64_t row = gamma_row_[at(i)];
        band(std::max(gap, row), std::min(gap, row)) = difference_[at(k)];
      }
    missing -= !seen_[at(i)];
  }
}

bool DifferenceSmoother::factor(double half_power) {
  const double log_r = log_intensity(order_, half_power);
  // Below this the smallest eigenvalue of D D' + r B is lost in rounding (measured: docs/theory/measures.md).
  if (!(log_r > std::log(1e-12))) return false;
  assemble(std::exp(log_r));
  log_determinant_ = 0.0;
  const std::int64_t stride = width_ + 1;
  std::vector<double> scaled(at(stride));                       // L D of the row in hand
  std::vector<double> entered(at(stride)), before(at(stride));  // this row and the last, before the factor
  std::int64_t equal = 0;  // rows up to the last that equal the one before them, in all digits
  double log_pivot = 0.0;
  for (std::int64_t row = 0; row < unknowns_; ++row) {
    const std::int64_t first = first_[at(row)], reach = row - first;
    double* here = &factor_[at(row * stride)];
    std::copy_n(here, stride, entered.begin());
    const bool as_before = row > 0 && reach == row - 1 - first_[at(row - 1)] && entered == before;
    if (as_before && equal > reach) {
      // All that enters this row is what entered the last one: so is all that comes of it.
      std::copy_n(here - stride, stride, here);
      log_determinant_ += log_pivot;
      continue;
    }
    double pivot = here[width_];
    for (std::int64_t column = first; column < row; ++column) {
      const double* other = &factor_[at(column * stride)];
      double value = here[column - row + width_];
      for (std::int64_t k = std::max(first, first_[at(column)]); k < column; ++k)
        value -= other[k - column + width_] * scaled[at(k - first)];
      scaled[at(column - first)] = value;
      const double l = value / other[width_];
      here[column - row + width_] = l;
      pivot -= l * value;
    }
    if (pivot == 0.0 || !std::isfinite(pivot)) return false;
    here[width_] = pivot;
    log_pivot = std::log(std::abs(pivot));
    log_determinant_ += log_pivot;
    equal = as_before && std::equal(here, here + stride, here - stride) ? equal + 1 : 0;
    std::swap(entered, before);
  }
  return true;
}

// The factor as the loops below see it.
struct DifferenceSmoother::Band {
  std::int64_t samples, order, unknowns, width;
  const double* difference;
  const double* factor;
  const std::int64_t* gamma_row;
  const std::int64_t* gap_row;
  const std::int64_t* first;
  const std::int64_t* last;
};

namespace {

// Columns side by side: in vectors, or one by one.
template <int kVectors>
struct Wide {
  static constexpr std::int64_t kColumns = kVectors * kLanes;
  Lanes part[kVectors];
  [[gnu::always_inline]] void read(const double* from) {
    for (int v = 0; v < kVectors; ++v) load(part[v], from + v * kLanes);
  }
  [[gnu::always_inline]] void write(double* to) const {
    for (int v = 0; v < kVectors; ++v) store(to + v * kLanes, part[v]);
  }
  [[gnu::always_inline]] void clear() {
    for (int v = 0; v < kVectors; ++v) spread(part[v], 0.0);
  }
  [[gnu::always_inline]] void add(double factor, const double* from) {
    for (int v = 0; v < kVectors; ++v) {
      Lanes other;
      load(other, from + v * kLanes);
      part[v] += factor * other;
    }
  }
  [[gnu::always_inline]] void take(double factor, const double* from) {
    for (int v = 0; v < kVectors; ++v) {
      Lanes other;
      load(other, from + v * kLanes);
      part[v] -= factor * other;
    }
  }
  [[gnu::always_inline]] void divide(double by) {
    for (int v = 0; v < kVectors; ++v) part[v] /= by;
  }
};
struct Single {
  static constexpr std::int64_t kColumns = 1;
  double part;
  [[gnu::always_inline]] void read(const double* from) { part = *from; }
  [[gnu::always_inline]] void write(double* to) const { *to = part; }
  [[gnu::always_inline]] void clear() { part = 0.0; }
  [[gnu::always_inline]] void add(double factor, const double* from) { part += factor * *from; }
  [[gnu::always_inline]] void take(double factor, const double* from) { part -= factor * *from; }
  [[gnu::always_inline]] void divide(double by) { part /= by; }
};

// Forward, back and out of the unknowns for some columns side by side, each as it would be alone.
// @param u  room for the unknowns of the columns
template <class Columns, class Band>
[[gnu::always_inline]] inline void solve_columns(const Band& of, double* series, std::int64_t stride,
                                                 double* u) {
  constexpr std::int64_t kColumns = Columns::kColumns;
  const std::int64_t n = of.samples, m = of.order, w = of.width;
  Columns sum;
  const auto forward = [&](std::int64_t row) __attribute__((always_inline)) {
    const double* l = of.factor + row * (w + 1) + w - row;
    for (std::int64_t column = of.first[row]; column < row; ++column)
      sum.take(l[column], u + column * kColumns);
    sum.write(u + row * kColumns);
  };
  for (std::int64_t i = 0; i < n; ++i) {
    if (i < n - m) {
      sum.clear();
      for (std::int64_t k = 0; k <= m; ++k) sum.add(of.difference[k], series + (i + k) * stride);
      forward(of.gamma_row[i]);
    }
    if (of.gap_row[i] >= 0) {
      sum.clear();
      forward(of.gap_row[i]);
    }
  }
  for (std::int64_t row = of.unknowns - 1; row >= 0; --row) {
    sum.read(u + row * kColumns);
    sum.divide(of.factor[row * (w + 1) + w]);
    // Rows below have taken their part of this one already.
    for (std::int64_t below = row + 1; below <= of.last[row]; ++below)
      if (of.first[below] <= row)
        sum.take(of.factor[below * (w + 1) + row - below + w], u + below * kColumns);
    sum.write(u + row * kColumns);
  }
  for (std::int64_t i = 0; i < n; ++i) {
    sum.read(series + i * stride);
    if (of.gap_row[i] >= 0) {
      sum.take(1.0, u + of.gap_row[i] * kColumns);
    } else {
      for (std::int64_t k = std::max<std::int64_t>(0, i - (n - m - 1)); k <= std::min(m, i); ++k)
        sum.take(of.difference[k], u + of.gamma_row[i - k] * kColumns);
    }
    sum.write(series + i * stride);
  }
}

}  // namespace

template <class Columns>
void DifferenceSmoother::solve(double* series, std::int64_t stride, std::vector<double>& unknown) const {
  unknown.resize(at(unknowns_ * Columns::kColumns));
  const Band band{.samples = samples(),
                  .order = order_,
                  .unknowns = unknowns_,
                  .width = width_,
                  .difference = difference_.data(),
                  .factor = factor_.data(),
                  .gamma_row = gamma_row_.data(),
                  .gap_row = gap_row_.data(),
                  .first = first_.data(),
                  .last = last_.data()};
  run_wide<solve_columns<Columns, Band>>(band, series, stride, unknown.data());
}

void DifferenceSmoother::smooth(SeriesMatrix& series) const {
  const std::int64_t n = samples(), columns = series.cols();
  check(series.rows() == n, "a smoother takes series of its own length");
  // Row by row, so that a column's digits do not depend on those beside it.
  Eigen::RowVectorXd level = Eigen::RowVectorXd::Zero(columns);
  for (std::int64_t i = 0; i < n; ++i)
    if (seen_[at(i)]) level += series.row(i);
  level /= static_cast<double>(std::ranges::count(seen_, true));
  series.rowwise() -= level;
  fill_straight(seen_, series);
  std::vector<double> unknown;
  std::int64_t done = 0;
  for (; done + 12 <= columns; done += 12) solve<Wide<3>>(series.data() + done, columns, unknown);
  for (; done + 4 <= columns; done += 4) solve<Wide<1>>(series.data() + done, columns, unknown);
  if (columns - done > 1) {
    // Two or three, with columns of zeros for company.
    SeriesMatrix four = SeriesMatrix::Zero(n, kLanes);
    four.leftCols(columns - done) = series.rightCols(columns - done);
    solve<Wide<1>>(four.data(), kLanes, unknown);
    series.rightCols(columns - done) = four.leftCols(columns - done);
  } else if (columns > done) {
    solve<Single>(series.data() + done, columns, unknown);
  }
  series.rowwise() += level;
}

}  // namespace kinemark::math
