// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"

namespace kinemark::math {
namespace {

bool has_nan(std::span<const double> values) {
  return std::ranges::any_of(values, [](double v) { return std::isnan(v); });
}

}  // namespace

double nth_smallest(std::span<const double> values, std::size_t rank) {
  if (values.empty() || has_nan(values)) return kNaN;
  check(rank < values.size(), "nth_smallest(): the rank is below the number of values");
  std::vector<double> copy(values.begin(), values.end());
  const auto nth = copy.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(copy, nth);
  return *nth;
}

double median(std::span<const double> values) {
  if (values.empty() || has_nan(values)) return kNaN;
  std::vector<double> copy(values.begin(), values.end());
  const auto middle = copy.begin() + static_cast<std::ptrdiff_t>(copy.size() / 2);
  std::ranges::nth_element(copy, middle);
  if (copy.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(copy.begin(), middle));
}

double upper_median(std::span<const double> values) { return nth_smallest(values, values.size() / 2); }

double quantile(std::span<const double> values, double share) {
  check(share >= 0.0 && share <= 1.0, "quantile(): a share is from 0 to 1");
  if (values.empty()) return kNaN;
  const double rank = share * static_cast<double>(values.size() - 1);
  return nth_smallest(values, static_cast<std::size_t>(std::lround(rank)));
}

}  // namespace kinemark::math
