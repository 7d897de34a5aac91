// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

namespace kinemark::trajectory::internal {

using Eigen::Index;

/// A gap and the samples next to it: `left` before, `length` missing, `right` after. Either side may be 0.
struct GapShape {
  Index length = 0;
  Index left = 0;
  Index right = 0;
  [[nodiscard]] Index near() const { return left + right; }
  auto operator<=>(const GapShape&) const = default;
};

/// Fills that are linear in the samples next to the gap: x_gap = A x_near, A is length x near().
/// Straight line between the two sides; with one side its nearest sample.
[[nodiscard]] Eigen::MatrixXd chord_operator(const GapShape& shape);
/// Interpolating cubic spline, not-a-knot. Needs both sides.
[[nodiscard]] Eigen::MatrixXd spline_operator(const GapShape& shape);
/// Posterior mean of an order-fold integrated random walk: sum_near (y - x)^2 + lambda sum |D^order x|^2 is
/// least. Needs near() >= order. O((length + near) near order).
[[nodiscard]] Eigen::MatrixXd walk_operator(const GapShape& shape, int order, double lambda);
/// lambda for a cut-off: (2 sin(pi f / rate))^(-2 order).
[[nodiscard]] double walk_lambda(int order, double cutoff_hz, double rate_hz);

/// Monotone cubic through the two samples nearest on either side (all that it depends on), at given rows of
/// the gap. near is near() x C; needs both sides.
[[nodiscard]] Eigen::MatrixXd pchip_fill(const GapShape& shape, const Eigen::MatrixXd& near,
                                         const Eigen::VectorX<Index>& rows);

/// Matrices of the walk at a few rows, remembered. Safe to share between threads; values never depend on what
/// was asked before.
class WalkCache {
 public:
  /// Rows of walk_operator().
  std::shared_ptr<const Eigen::MatrixXd> get(const GapShape& shape, int order, double lambda,
                                             const Eigen::VectorX<Index>& rows);

 private:
  using Key = std::tuple<GapShape, int, double, Index>;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Eigen::MatrixXd>> known_;
  Index numbers_ = 0;
};

}  // namespace kinemark::trajectory::internal
