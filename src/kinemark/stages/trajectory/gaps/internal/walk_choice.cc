// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/walk_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kinemark::trajectory::internal {
namespace {

constexpr std::array kCutoffsHz = {1.0, 1.6, 2.5, 4.0, 6.3, 10.0, 16.0, 25.0, 45.0};
constexpr double kHighestOfRate = 0.45;
constexpr double kWorstCondition = 1e13;  // of the normal matrix; beyond it the solution is rounding

}  // namespace

std::optional<Walk> WalkChooser::best(const Signal& target, int lowest_order, int highest_order) const {
  const GapProblem& p = *problem_;
  double least = std::numeric_limits<double>::infinity();
  int order = 0;
  double lambda = 0.0;
  Walk walk;
  for (int m = lowest_order; m <= highest_order; ++m) {
    if (p.shape.near() < 2 * m) continue;
    for (const double cutoff : kCutoffsHz) {
      if (cutoff > kCutoffsHz.front() && cutoff >= kHighestOfRate * rate_hz_) continue;
      const double l = walk_lambda(m, std::min(cutoff, kHighestOfRate * rate_hz_), rate_hz_);
      if (l * std::pow(4.0, m) > kWorstCondition) continue;
      const auto A = cache_->get(p.window, m, l, p.rows);
      const double error = (target.rows - *A * target.near).squaredNorm();
      if (error >= least) continue;
      least = error;
      order = m;
      lambda = l;
      walk.rows = A;
    }
  }
  if (!walk.rows) return std::nullopt;
  walk.gap = cache_->get(p.shape, order, lambda, p.all_rows);
  return walk;
}

}  // namespace kinemark::trajectory::internal
