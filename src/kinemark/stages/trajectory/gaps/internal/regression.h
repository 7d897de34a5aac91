// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

namespace kinemark::trajectory::internal {

/// Consecutive windows [first, end) that are left out together, and those that do not overlap them.
struct Fold {
  Index first = 0;
  Index end = 0;
  std::vector<Index> train;
};

[[nodiscard]] std::vector<Fold> make_folds(const GapProblem& problem);

/// Residual of a temporal fill, or, untied, the distance from the mean over all windows.
struct Innovation {
  Index width = 0;           ///< P
  Eigen::MatrixXd rows;      ///< R x W P
  Eigen::MatrixXd gap;       ///< L x P; empty for the target
  Eigen::MatrixXd gap_near;  ///< H x P, untied only
  Eigen::RowVectorXd mean;   ///< P, untied only
};

/// A is known at the rows of the windows (R x H) and in the whole gap (L x H).
[[nodiscard]] Innovation tie(const Signal& signal, const Eigen::MatrixXd& A_rows,
                             const Eigen::MatrixXd& A_gap);
[[nodiscard]] Innovation untie(const Signal& signal);

/// Ridge regression of innovations on innovations.
struct Regression {
  double mean_square = 0.0;  ///< leave-windows-out, m^2 per axis
  Eigen::MatrixXd errors;    ///< R x 3 W, leave-windows-out
  Eigen::MatrixXd gap;       ///< L x 3, predicted innovation of the target
  Eigen::MatrixXd gap_near;  ///< H x 3, what is left of the target beside the gap; untied only
  /// How far the features lie, in the gap, outside of what was learnt from, as a multiple of how far they do
  /// on windows left out: root of mean z' (Z'Z + penalty)^-1 z over the same.
  double stretch = 1.0;
};

/// Penalty (1e-6 to 1e-1 of the mean feature power) and number of features (one of `widths`, the first so
/// many) have the smallest leave-windows-out error. Untied: the mean of the training windows is part of the
/// prediction. y has width 3.
[[nodiscard]] Regression regress(const Innovation& y, const Innovation& z, const std::vector<Fold>& folds,
                                 std::span<const Index> widths, bool untied);

}  // namespace kinemark::trajectory::internal
