// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/measure.h"

namespace kinemark::analysis::testing {

/// Gaussian curves of mean 0 and deviation 1: sums of bumps `width` points wide, drawn from `random`.
inline data::CycleCurves random_curves(Random& random, std::int64_t count, double width,
                                       std::int64_t points = 101) {
  data::CycleCurves curves{.id = "curve", .subject = "group", .points = points};
  const auto reach = static_cast<std::int64_t>(std::ceil(4.0 * width));
  for (std::int64_t i = 0; i < count; ++i) {
    curves.cycles.push_back(std::to_string(i));
    std::vector<double> noise(static_cast<std::size_t>(points + 2 * reach));
    for (double& e : noise) e = random.gaussian();
    for (std::int64_t p = 0; p < points; ++p) {
      double sum = 0.0, squares = 0.0;
      for (std::int64_t k = -reach; k <= reach; ++k) {
        const double weight = std::exp(-0.5 * static_cast<double>(k * k) / (width * width));
        sum += weight * noise[static_cast<std::size_t>(p + reach + k)];
        squares += weight * weight;
      }
      curves.values.push_back(sum / std::sqrt(squares));
    }
  }
  return curves;
}

/// Curves of one value each: what textbooks work out by hand.
inline data::CycleCurves numbers(const std::vector<double>& values) {
  data::CycleCurves curves{.id = "number", .subject = "group", .points = 2};
  for (const double value : values) {
    curves.cycles.push_back(std::to_string(curves.cycles.size()));
    curves.values.insert(curves.values.end(), {value, value});
  }
  return curves;
}

}  // namespace kinemark::analysis::testing
