// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cholesky factors of small symmetric matrices, in place and without allocation.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace kinemark::skeleton::articulated {

/// A = L L^T; reads and overwrites the lower triangle. False when a pivot is at most `least`.
inline bool cholesky(Eigen::MatrixXd& A, double least = 0.0) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = A.data() + j * n;
    if (!(column[j] > least)) return false;
    const double root = std::sqrt(column[j]);
    column[j] = root;
    for (Eigen::Index i = j + 1; i < n; ++i) column[i] /= root;
    for (Eigen::Index c = j + 1; c < n; ++c) {
      const double factor = column[c];
      if (factor == 0.0) continue;
      double* other = A.data() + c * n;
      for (Eigen::Index i = c; i < n; ++i) other[i] -= factor * column[i];
    }
  }
  return true;
}

/// x <- L^-1 x.
template <class Column>
void solve_lower(const Eigen::MatrixXd& L, Column&& x) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double* column = L.data() + j * n;
    const double value = x[j] / column[j];
    x[j] = value;
    if (value == 0.0) continue;
    for (Eigen::Index i = j + 1; i < n; ++i) x[i] -= value * column[i];
  }
}

/// x <- L^-T x.
template <class Column>
void solve_upper(const Eigen::MatrixXd& L, Column&& x) {
  const Eigen::Index n = L.rows();
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    const double* column = L.data() + j * n;
    double value = x[j];
    for (Eigen::Index i = j + 1; i < n; ++i) value -= column[i] * x[i];
    x[j] = value / column[j];
  }
}

/// x <- A^-1 x for the factor L of A.
template <class Column>
void solve_cholesky(const Eigen::MatrixXd& L, Column&& x) {
  solve_lower(L, x);
  solve_upper(L, x);
}

}  // namespace kinemark::skeleton::articulated
