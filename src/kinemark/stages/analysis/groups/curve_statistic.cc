// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/curve_statistic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

constexpr double kLeastError = 1e-15;  // of all squares
constexpr EnumNames<Design::one_way> kDesigns{"one sample", "paired", "two samples", "one way"};

}  // namespace

std::string_view to_string(Design design) { return kDesigns[design]; }

CurveStatistic::CurveStatistic(Design design, std::span<const data::CycleCurves> groups)
    : design_(design), points_(static_cast<std::size_t>(groups.front().points)) {
  for (const auto& group : groups) {
    if (design == Design::paired && &group != groups.data()) break;
    sizes_.push_back(group.count());
    values_.insert(values_.end(), group.values.begin(), group.values.end());
    curves_ += group.count();
  }
  if (design == Design::paired)
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] -= groups[1].values[i];

  squares_.resize(points_);
  sums_.resize(sizes_.size() * points_);
  const auto n = static_cast<double>(curves_);
  for (std::size_t p = 0; p < points_; ++p) {
    const auto column = [&](std::int64_t i) -> double& {
      return values_[static_cast<std::size_t>(i) * points_ + p];
    };
    double mean = 0.0, largest = 0.0, squares = 0.0;
    for (std::int64_t i = 0; i < curves_; ++i) {
      mean += column(i) / n;
      largest = std::max(largest, std::abs(column(i)));
    }
    for (std::int64_t i = 0; i < curves_; ++i) {
      if (!signs()) column(i) -= mean;
      squares += column(i) * column(i);
    }
    // What rounding alone leaves of equal curves is no variance.
    const double rounding = 8.0 * n * std::numeric_limits<double>::epsilon() * largest;
    squares_[p] = std::isfinite(squares) && squares > rounding * rounding ? squares : kNaN;
  }
}

Arrangements CurveStatistic::arrangements(std::int64_t most, std::uint64_t seed) const {
  return signs() ? Arrangements::of_signs(curves_, most, seed) : Arrangements::of_groups(sizes_, most, seed);
}

void CurveStatistic::of(const Arrangements::Labels& labels, std::span<double> statistic) {
  std::ranges::fill(sums_, 0.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double* const curve = values_.data() + i * points_;
    double* const sums = sums_.data() + (signs() ? 0 : labels[i] * points_);
    const double sign = signs() && labels[i] == 1 ? -1.0 : 1.0;
    for (std::size_t p = 0; p < points_; ++p) sums[p] += sign * curve[p];
  }
  const auto n = static_cast<double>(curves_);
  const auto error = static_cast<double>(error_df());
  for (std::size_t p = 0; p < points_; ++p) {
    double between = 0.0;
    for (std::size_t g = 0; g < sizes_.size(); ++g)
      between += sums_[g * points_ + p] * sums_[g * points_ + p] / static_cast<double>(sizes_[g]);
    // Of equal curves within groups the statistic is very large, not infinite: spans have integrals.
    const double variance = std::max(kLeastError * squares_[p], squares_[p] - between) / error;
    if (std::isnan(squares_[p])) {
      statistic[p] = kNaN;
    } else if (design_ == Design::one_way) {
      statistic[p] = between / static_cast<double>(effect_df()) / variance;
    } else if (design_ == Design::two_sample) {
      const auto a = static_cast<double>(sizes_[0]), b = static_cast<double>(sizes_[1]);
      statistic[p] = (sums_[p] / a - sums_[points_ + p] / b) / std::sqrt(variance * (1.0 / a + 1.0 / b));
    } else {
      statistic[p] = sums_[p] / n / std::sqrt(variance / n);
    }
  }
}

}  // namespace kinemark::analysis
