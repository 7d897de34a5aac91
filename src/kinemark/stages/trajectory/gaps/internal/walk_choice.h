// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

namespace kinemark::trajectory::internal {

/// A temporal fill at the rows of the windows (R x H) and in the whole gap (L x H).
struct Walk {
  std::shared_ptr<const Eigen::MatrixXd> rows;
  std::shared_ptr<const Eigen::MatrixXd> gap;
};

/// Chooses order and bandwidth of the integrated random walk by their error on the windows. (What is best
/// for smoothing, as SURE finds it, is far too stiff for gaps.)
class WalkChooser {
 public:
  WalkChooser(const GapProblem& problem, double rate_hz, WalkCache& cache)
      : problem_(&problem), rate_hz_(rate_hz), cache_(&cache) {}
  /// The best one of these orders for a target of width 3; nothing when no order is possible.
  [[nodiscard]] std::optional<Walk> best(const Signal& target, int lowest_order, int highest_order) const;

 private:
  const GapProblem* problem_;
  double rate_hz_;
  WalkCache* cache_;
};

}  // namespace kinemark::trajectory::internal
