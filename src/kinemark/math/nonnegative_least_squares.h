// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace kinemark::math {

/// Minimise x'Nx/2 - b'x over x >= 0 for a symmetric positive semidefinite N (n x n), by cyclic coordinate
/// descent.
///
/// Unknowns with N(i,i) = 0 stay 0. Stops when no unknown moves by more than `tolerance` times the largest,
/// or after 10,000 sweeps. O(n^2) per sweep. Used for variance components, where n is tens and N well scaled.
[[nodiscard]] Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& N, const Eigen::VectorXd& b,
                                                        double tolerance = 1e-10);

}  // namespace kinemark::math
