// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Monomials x^(k-j) y^j, k from the lowest to the highest degree, j from 0 to k, with both derivatives.
/// Holds its numbers itself: no allocation.
class Monomials {
 public:
  static constexpr int kMost =
      (data::kHighestDegree + 1) * (data::kHighestDegree + 2) / 2;  ///< terms at most

  /// lowest >= 0, highest <= data::kHighestDegree; highest < lowest: none.
  Monomials(double x, double y, int lowest, int highest);

  [[nodiscard]] int size() const { return size_; }                 ///< number of terms
  [[nodiscard]] auto value() const { return value_.head(size_); }  ///< the terms, size() of them
  [[nodiscard]] auto d_x() const { return d_x_.head(size_); }      ///< their derivatives by x
  [[nodiscard]] auto d_y() const { return d_y_.head(size_); }      ///< their derivatives by y

 private:
  using Terms = Eigen::Matrix<double, kMost, 1>;
  int size_ = 0;
  Terms value_, d_x_, d_y_;
};

}  // namespace kinemark::camera
