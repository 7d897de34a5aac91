// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The measures of a path: what each is, when it means something, and how its interval is made.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/path/path_facts.h"
#include "kinemark/stages/analysis/path/thinned.h"

namespace kinemark::analysis {

/// Of which movements a measure is told unless it is asked for by name.
enum class Applies : std::uint8_t {
  always,
  periodic,
  closed,
  round,  ///< closed, or goes around by 0.6 turns or more
  whole,  ///< closed, or goes around by a turn or more
  discrete
};

/// How value and interval follow from refits of simulated noise (docs/theory/measures.md).
enum class Pivot : std::uint8_t {
  plain,          ///< both from 1.5 times the cut-off of least error
  of_derivative,  ///< the value likewise, the interval from 2.5 times: third derivatives, curvature, torsion
  squared,        ///< on the squares of the values, which noise raises by a constant: thickness
  of_ratio,       ///< of the larger to the smaller, on the square of 1 - 1 / ratio^2, to which noise adds a
                  ///< constant where both are alike and where the divisor is nothing but noise
  raw_squared,    ///< on the squares, from unsmoothed samples: what is in a band of frequencies
  whole_number,   ///< counts: rounded
};

/// What keeps an interval from being two-sided and sure.
enum class Weakness : std::uint8_t {
  none,
  lengthened_at_rest,       ///< a path's noise at rest adds up: at most, where part of the stretch is at rest
  extreme_of_constant,      ///< the largest of a speed that hardly changes: at most then
  needs_change,             ///< says nothing of a speed that hardly changes
  upper_alone,              ///< the lower end fails: the least side of a box, which may have none
  upper_if_discrete,        ///< at most for discrete movements: noise at both rests can only lengthen them
  of_instants,              ///< noise moves the instants between which it is taken: none if correlated
  upper_alone_if_discrete,  ///< likewise for discrete movements: a start has jerk that no filter passes
  approximate,              ///< covers less than its level in simulated movements
  approximate_if_discrete   ///< likewise for discrete movements alone
};

/// What a velocity that jumps, as at an impact, leaves of a measure.
enum class AtJumps : std::uint8_t {
  holds,      ///< all of it
  at_least,   ///< there is more than is seen
  unbounded,  ///< nothing: jerk
  of_speed,   ///< nothing where the speed is largest at a jump
};

/// One measure of a path.
struct PathDefinition {
  data::MeasureDefinition what;                       ///< its line in `--list`
  Applies applies = Applies::always;                  ///< to which movements
  Pivot pivot = Pivot::plain;                         ///< how bias and interval are found
  Weakness weakness = Weakness::none;                 ///< what the interval may not claim
  double (*value)(const PathFacts& facts) = nullptr;  ///< SI; NaN where not determined
  bool needs_slow_noise = false;  ///< it has an interval only where slow noise is told from movement
  /// Of an extreme: the same without the bias of choosing it; null: it is none.
  double (*thinned)(const ThinnedExtremes& extremes) = nullptr;
  /// Square of the deviation that repetitions add which differ, as noise makes them as well; null: none.
  double (*wander)(const PathFacts& facts) = nullptr;
  AtJumps at_jumps = AtJumps::holds;  ///< what is left of it where the velocity jumps
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const PathDefinition> path_definitions();

}  // namespace kinemark::analysis
