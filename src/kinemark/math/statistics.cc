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

constexpr std::size_t kMany = 4096;  // values of which some tell first between which others the median lies

// The median of many values without NaN, from those between two bounds alone, which a sample of them gives
// (Floyd & Rivest 1975); NaN where the median lies outside.
double median_between_bounds(std::span<const double> values) {
  constexpr std::size_t kSample = 512, kAround = 48;  // four standard deviations of a rank in the sample
  const std::size_t n = values.size(), rank = n / 2, step = n / kSample;
  std::vector<double> sample;
  for (std::size_t i = 0; i < kSample; ++i) sample.push_back(values[i * step]);
  std::ranges::sort(sample);
  const double low = sample[kSample / 2 - kAround], high = sample[kSample / 2 + kAround];
  std::size_t below = 0, kept = 0;
  std::vector<double> between(n + 1);
  for (const double v : values) {
    between[kept] = v;  // overwritten where it is not one of them
    kept += v >= low && v <= high;
    below += v < low;
  }
  if (rank < below + 1 || rank >= below + kept) return kNaN;
  const auto middle = between.begin() + static_cast<std::ptrdiff_t>(rank - below);
  std::nth_element(between.begin(), middle, between.begin() + static_cast<std::ptrdiff_t>(kept));
  return n % 2 == 1 ? *middle : 0.5 * (*middle + *std::max_element(between.begin(), middle));
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
  if (values.size() >= kMany)
    if (const double found = median_between_bounds(values); !std::isnan(found)) return found;
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
