// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cholesky factors of small symmetric matrices, in place and without allocation.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

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

/// A = U U^T with U upper triangular, from the last row to the first; reads and overwrites the upper
/// triangle. False when a pivot is at most 0. Where rows of a tree's leaves stand behind those of its root,
/// as in a chain, nothing fills in: zeros stay zero and are passed over. `rows`: memory to work in.
inline bool cholesky_from_leaves(Eigen::MatrixXd& A, std::vector<Eigen::Index>& rows) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    double* column = A.data() + j * n;
    if (!(column[j] > 0.0)) return false;
    const double root = std::sqrt(column[j]);
    column[j] = root;
    rows.clear();
    for (Eigen::Index i = 0; i < j; ++i) {
      if (column[i] == 0.0) continue;
      column[i] /= root;
      rows.push_back(i);
    }
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const double factor = column[rows[c]];
      double* other = A.data() + rows[c] * n;
      for (std::size_t i = 0; i <= c; ++i) other[rows[i]] -= factor * column[rows[i]];
    }
  }
  return true;
}

/// x <- U^-1 x.
template <class Column>
void solve_from_leaves(const Eigen::MatrixXd& U, Column&& x) {
  for (Eigen::Index j = U.rows() - 1; j >= 0; --j) {
    if (x[j] == 0.0) continue;
    const double* column = U.data() + j * U.rows();
    const double value = x[j] / column[j];
    x[j] = value;
    for (Eigen::Index i = 0; i < j; ++i) x[i] -= value * column[i];
  }
}

/// x <- U^-T x.
template <class Column>
void solve_to_leaves(const Eigen::MatrixXd& U, Column&& x) {
  for (Eigen::Index j = 0; j < U.rows(); ++j) {
    const double* column = U.data() + j * U.rows();
    double value = x[j];
    for (Eigen::Index i = 0; i < j; ++i) value -= column[i] * x[i];
    x[j] = value / column[j];
  }
}

}  // namespace kinemark::skeleton::articulated
