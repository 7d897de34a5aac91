// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// t and F at each point of curves, for any arrangement of their labels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/groups/arrangements.h"

namespace kinemark::analysis {

/// What is compared.
enum class Design : std::uint8_t {
  one_sample,  ///< the mean of one group with 0: t
  paired,      ///< curve i of one group with curve i of the other: t of the differences
  two_sample,  ///< two groups, equal variances: t
  one_way,     ///< two or more groups, equal variances: F
};

/// "one sample", "paired", "two samples" or "one way".
[[nodiscard]] std::string_view to_string(Design design);

/// Curves prepared so that the statistic of an arrangement costs one sum over them. N curves, P points, G
/// groups.
class CurveStatistic {
 public:
  /// Contract: groups fit the design (validated by map_curves), and all have the same number of points.
  CurveStatistic(Design design, std::span<const data::CycleCurves> groups);

  /// As many labels as there are curves (differences, of a paired design), and as many arrangements as asked.
  [[nodiscard]] Arrangements arrangements(std::int64_t most, std::uint64_t seed) const;

  /// The statistic of an arrangement, into P numbers: NaN where a curve is missing, or where no curve differs
  /// from another (with 0 in one sample).
  void of(const Arrangements::Labels& labels, std::span<double> statistic);

  /// P.
  [[nodiscard]] std::size_t points() const { return points_; }
  /// Degrees of freedom: of the effect (F alone, else 1) and of the error.
  [[nodiscard]] std::int64_t effect_df() const {
    return design_ == Design::one_way ? std::ssize(sizes_) - 1 : 1;
  }
  /// N - G, or N - 1 of signs.
  [[nodiscard]] std::int64_t error_df() const { return curves_ - (signs() ? 1 : std::ssize(sizes_)); }

 private:
  [[nodiscard]] bool signs() const { return design_ == Design::one_sample || design_ == Design::paired; }

  Design design_;
  std::vector<std::int64_t> sizes_;  ///< G
  std::int64_t curves_ = 0;
  std::size_t points_ = 0;
  std::vector<double> values_;   ///< N x P, less each point's mean unless signs are turned
  std::vector<double> squares_;  ///< P sums of squares; NaN where the point is left out
  std::vector<double> sums_;     ///< G x P, of the arrangement
};

}  // namespace kinemark::analysis
