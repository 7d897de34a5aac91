// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/sway.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {

using math::SeriesMatrix;

double mean_distance(const SeriesMatrix& x) {
  return (x.rowwise() - x.colwise().mean()).rowwise().norm().mean();
}

double ellipse_area(const SeriesMatrix& x) {
  const auto n = static_cast<double>(x.rows());
  if (n < 4.0) return kNaN;
  const SeriesMatrix level = x.rowwise() - x.colwise().mean();
  const Eigen::Matrix2d spread = level.transpose() * level / n;
  // With two degrees of freedom above, 1 - p = (1 + 2 F / (n - 2))^(-(n - 2) / 2).
  const double fisher = 0.5 * (n - 2.0) * (std::pow(0.05, -2.0 / (n - 2.0)) - 1.0);
  return 2.0 * std::numbers::pi * fisher * std::sqrt(std::max(0.0, spread.determinant()));
}

double mean_frequency(const SeriesMatrix& x, double duration_s) {
  const double radius = mean_distance(x);
  return radius > 0.0 ? path_length(x) / (2.0 * std::numbers::pi * radius * duration_s) : kNaN;
}

}  // namespace kinemark::analysis
