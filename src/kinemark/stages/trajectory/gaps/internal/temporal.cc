// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/temporal.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace kinemark::trajectory::internal {
namespace {

constexpr Index kMaxCachedNumbers = 4'000'000;

/// Time of a near sample in frames after the first one of the left side.
Index near_time(const GapShape& s, Index k) { return k < s.left ? k : k + s.length; }

/// Three-point slope of Fritsch and Carlson as Brodlie weighted it: 0 at a turning point.
double inner_slope(double h0, double d0, double h1, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

Eigen::MatrixXd chord_operator(const GapShape& s) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(s.length, s.near());
  for (Index i = 0; i < s.length; ++i) {
    const double u = s.left == 0    ? 1.0
                     : s.right == 0 ? 0.0
                                    : static_cast<double>(i + 1) / static_cast<double>(s.length + 1);
    if (s.left > 0) A(i, s.left - 1) = 1.0 - u;
    if (s.right > 0) A(i, s.left) = u;
  }
  return A;
}

Eigen::MatrixXd spline_operator(const GapShape& s) {
  const Index n = s.near();
  if (n < 3) return chord_operator(s);
  // Second derivatives M at the knots: C M = 6 D y with the usual rows inside and not-a-knot at both ends.
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  const auto h = [&](Index i) { return static_cast<double>(near_time(s, i + 1) - near_time(s, i)); };
  for (Index i = 1; i + 1 < n; ++i) {
    C(i, i - 1) = h(i - 1);
    C(i, i) = 2.0 * (h(i - 1) + h(i));
    C(i, i + 1) = h(i);
    D(i, i - 1) = 6.0 / h(i - 1);
    D(i, i) = -6.0 / h(i - 1) - 6.0 / h(i);
    D(i, i + 1) = 6.0 / h(i);
  }
  if (n == 3) {  // both end conditions coincide: one parabola
    C.row(0) << 1.0, -1.0, 0.0;
    C.row(2) << 0.0, 1.0, -1.0;
  } else {
    C(0, 0) = h(1);
    C(0, 1) = -h(0) - h(1);
    C(0, 2) = h(0);
    C(n - 1, n - 1) = h(n - 3);
    C(n - 1, n - 2) = -h(n - 3) - h(n - 2);
    C(n - 1, n - 3) = h(n - 2);
  }
  const Eigen::MatrixXd M = C.partialPivLu().solve(D);
  const Index k = s.left - 1;
  const double width = h(k);
  Eigen::MatrixXd A(s.length, n);
  for (Index i = 0; i < s.length; ++i) {
    const double b = static_cast<double>(i + 1) / width;
    const double a = 1.0 - b;
    A.row(i) = width * width / 6.0 * ((a * a * a - a) * M.row(k) + (b * b * b - b) * M.row(k + 1));
    A(i, k) += a;
    A(i, k + 1) += b;
  }
  return A;
}

double walk_lambda(int order, double cutoff_hz, double rate_hz) {
  return std::pow(2.0 * std::sin(std::numbers::pi * cutoff_hz / rate_hz), -2.0 * order);
}

Eigen::MatrixXd walk_operator(const GapShape& s, int order, double lambda) {
  const Index n = s.length + s.near();
  std::vector<double> difference = {1.0};
  for (int k = 0; k < order; ++k) {
    difference.push_back(0.0);
    for (std::size_t i = difference.size() - 1; i > 0; --i) difference[i] -= difference[i - 1];
  }
  // Band of W + lambda D'D: row d holds the d-th diagonal below the main one.
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(order + 1, n);
  for (Index k = 0; k < n; ++k) band(0, k) = k < s.left || k >= s.left + s.length ? 1.0 : 0.0;
  for (Index r = 0; r + order < n; ++r)
    for (Index p = 0; p <= order; ++p)
      for (Index q = p; q <= order; ++q)
        band(q - p, r + p) +=
            lambda * difference[static_cast<std::size_t>(p)] * difference[static_cast<std::size_t>(q)];
  // Cholesky within the band, then both substitutions for all right-hand sides at once.
  for (Index c = 0; c < n; ++c) {
    band(0, c) = std::sqrt(std::max(band(0, c), 1e-300));
    const Index last = std::min<Index>(order, n - 1 - c);
    for (Index d = 1; d <= last; ++d) band(d, c) /= band(0, c);
    for (Index d = 1; d <= last; ++d)
      for (Index e = d; e <= last; ++e) band(e - d, c + d) -= band(e, c) * band(d, c);
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor X = RowMajor::Zero(n, s.near());
  for (Index k = 0; k < s.near(); ++k) X(near_time(s, k), k) = 1.0;
  for (Index r = 0; r < n; ++r) {
    for (Index d = 1; d <= std::min<Index>(order, r); ++d) X.row(r) -= band(d, r - d) * X.row(r - d);
    X.row(r) /= band(0, r);
  }
  for (Index r = n - 1; r >= 0; --r) {
    for (Index d = 1; d <= std::min<Index>(order, n - 1 - r); ++d) X.row(r) -= band(d, r) * X.row(r + d);
    X.row(r) /= band(0, r);
  }
  return X.middleRows(s.left, s.length);
}

Eigen::MatrixXd pchip_fill(const GapShape& s, const Eigen::MatrixXd& near,
                           const Eigen::VectorX<Index>& rows) {
  Eigen::MatrixXd out(rows.size(), near.cols());
  const double width = static_cast<double>(s.length + 1);
  for (Index c = 0; c < near.cols(); ++c) {
    const double y0 = near(s.left - 1, c);
    const double y1 = near(s.left, c);
    const double slope = (y1 - y0) / width;
    const double s0 = s.left > 1 ? inner_slope(1.0, y0 - near(s.left - 2, c), width, slope) : slope;
    const double s1 = s.right > 1 ? inner_slope(width, slope, 1.0, near(s.left + 1, c) - y1) : slope;
    for (Index i = 0; i < rows.size(); ++i) {
      const double u = static_cast<double>(rows(i) + 1) / width;
      const double v = 1.0 - u;
      out(i, c) =
          v * v * (1.0 + 2.0 * u) * y0 + u * u * (1.0 + 2.0 * v) * y1 + width * u * v * (v * s0 - u * s1);
    }
  }
  return out;
}

std::shared_ptr<const Eigen::MatrixXd> WalkCache::get(const GapShape& shape, int order, double lambda,
                                                      const Eigen::VectorX<Index>& rows) {
  const Key key(shape, order, lambda, rows.size());  // rows follow from length and number
  {
    const std::scoped_lock lock(mutex_);
    const auto at = known_.find(key);
    if (at != known_.end()) return at->second;
  }
  const Eigen::MatrixXd all = walk_operator(shape, order, lambda);
  auto made = std::make_shared<const Eigen::MatrixXd>(all(rows, Eigen::indexing::all));
  const std::scoped_lock lock(mutex_);
  if (numbers_ + made->size() > kMaxCachedNumbers) {
    known_.clear();
    numbers_ = 0;
  }
  if (known_.emplace(key, made).second) numbers_ += made->size();
  return made;
}

}  // namespace kinemark::trajectory::internal
