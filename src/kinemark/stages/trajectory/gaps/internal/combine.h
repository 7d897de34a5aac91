// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/fills.h"

namespace kinemark::trajectory::internal {

/// The fill that is used, combined from the candidates.
struct Combination {
  std::vector<double> weights;  ///< per candidate, >= 0, sum 1
  std::vector<bool> guarded;    ///< per candidate: left out because it deviates from the others
  Eigen::MatrixXd gap;          ///< L x 3, m
  Eigen::VectorXd sd_m;         ///< L, per axis; NaN without windows
};

/// Convex combination with weights that minimise the squared leave-gap-out error, or the one best candidate.
///
/// Candidates with more than 3 times the least error are excluded, and so are those that deviate in this gap:
/// further from the median of the others, or (untied ones) from the samples beside the gap, than their errors
/// allow. SD: errors of the combination on the windows, each rescaled by how much the candidates disagree
/// in this gap and in that window; see docs/theory/gaps.md. `fills` is not empty.
[[nodiscard]] Combination combine(const GapProblem& problem, const std::vector<Fill>& fills, bool only_best);

/// min w'Mw over w >= 0, sum w = 1, for a positive definite M.
[[nodiscard]] Eigen::VectorXd simplex_weights(const Eigen::MatrixXd& M);

}  // namespace kinemark::trajectory::internal
