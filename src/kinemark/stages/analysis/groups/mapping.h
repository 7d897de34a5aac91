// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One-dimensional statistical parametric mapping: where curves of groups differ, with the error over the
// whole curve kept, by permutation.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/groups/curve_statistic.h"

namespace kinemark::analysis {

/// How curves are compared.
struct MappingOptions {
  Design design = Design::two_sample;  ///< what is compared
  double alpha = 0.05;    ///< probability of any difference found where there is none, over the whole curve
  bool two_sided = true;  ///< differences of either sign count; F has no sides
  std::int64_t arrangements = 10'000;  ///< of the labels, at most: all where there are no more; at least 20
  std::uint64_t seed = 1;              ///< of the arrangements that are drawn

  /// Ranges as above; Code::usage.
  [[nodiscard]] Status check() const;
};

/// A span of the curve in which the statistic stays beyond the threshold.
struct MappedSpan {
  double first = kNaN;     ///< where it begins, in points from 0, interpolated
  double last = kNaN;      ///< where it ends
  double extreme = kNaN;   ///< largest statistic in it, with its sign
  double integral = kNaN;  ///< of what is beyond the threshold, statistic times points
  double p = kNaN;  ///< probability of a span of that integral or more, anywhere, if groups do not differ
};

/// Where groups differ.
struct Mapping {
  MappingOptions options;      ///< as asked
  std::string statistic;       ///< "t" or "F"
  std::int64_t effect_df = 1;  ///< degrees of freedom of the effect
  std::int64_t error_df = 0;   ///< degrees of freedom of the error
  std::vector<double> values;  ///< P, the statistic; NaN where not tested
  double threshold =
      kNaN;  ///< exceeded anywhere with probability `alpha` at most if groups do not differ; NaN: see remark
  double p = kNaN;                ///< of the largest value anywhere
  std::vector<MappedSpan> spans;  ///< beyond the threshold, in order
  double possible = 0.0;          ///< arrangements that there are
  std::int64_t arrangements = 0;  ///< arrangements used, the observed one among them
  std::int64_t not_tested = 0;    ///< points at which a curve is missing, or all are equal
  std::string remark;             ///< why nothing can be found; may be empty
};

/// Test where the mean curves of groups differ (one sample: where a mean curve differs from 0).
///
/// The threshold is that of the largest statistic over the curve in all arrangements of the labels (Nichols &
/// Holmes 2002; Pataky, Vanrenterghem & Robinson 2015), so that its error rate holds however smooth the
/// curves are. It asks that curves could change places if groups did not differ: equal variances between
/// groups, symmetric differences within pairs. A span is judged by its integral beyond the threshold.
///
/// @param groups  one (one sample), two (paired, two samples) or more groups of at least two curves, the same
/// points
/// @return        Code::bad_input where groups do not fit the design, with the numbers
/// Cost: arrangements x curves x points.
[[nodiscard]] Result<Mapping> map_curves(std::span<const data::CycleCurves> groups,
                                         const MappingOptions& options);

}  // namespace kinemark::analysis
