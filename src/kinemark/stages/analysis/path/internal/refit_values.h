// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Values of every measure that is asked for: of what was recorded, of the pilot, and of the refits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_facts.h"

namespace kinemark::analysis::internal {

/// What is taken of a ratio of the larger to the smaller: 0 where they are alike, 1 where the smaller is
/// nothing.
[[nodiscard]] inline double unlikeness(double ratio) { return 1.0 - 1.0 / (ratio * ratio); }

/// A value on the scale on which its deviations are taken: itself, its square, or that of the unlikeness.
[[nodiscard]] inline double on_scale(Pivot pivot, double value) {
  if (pivot == Pivot::of_ratio) value = unlikeness(value);
  return pivot == Pivot::squared || pivot == Pivot::of_ratio ? value * value : value;
}

/// One value for each definition, NaN where a measure is not taken of such a path.
struct RefitValues {
  std::vector<const PathDefinition*> definitions;
  std::vector<double> less, least, raw, pilot;
  std::vector<std::vector<double>> by_less, by_least, by_raw;  // deviations of the refits
  std::vector<double> let_through;                             // noise of each refit behind the smoother
  std::vector<double> thinned;                  // of extremes: of what was recorded, mean over refits
  std::vector<std::vector<double>> by_thinned;  // of extremes: deviations
  std::vector<double> wander;                   // of what was recorded (PathDefinition::wander), 0: none
  std::vector<double> wander_of_noise;          // what the refits' noise adds to the pilot's, mean over them

  explicit RefitValues(std::vector<const PathDefinition*> asked);

  // Which paths a measure is taken of.
  static bool of_less(Pivot pivot) { return pivot != Pivot::raw_squared; }
  static bool of_least(Pivot pivot) { return pivot == Pivot::of_derivative; }
  static bool of_raw(Pivot pivot) { return pivot == Pivot::raw_squared; }

  /// Whether any measure is taken of such paths.
  [[nodiscard]] bool any(bool (*taken)(Pivot)) const;
  [[nodiscard]] bool any_extreme() const;
  /// @param wanders  gets what repetitions add to each, where not null
  [[nodiscard]] std::vector<double> values(const PathSamples& path, const PathFrame& frame,
                                           bool (*taken)(Pivot), const NearPath* near = nullptr,
                                           std::vector<double>* wanders = nullptr) const;
  /// Thinned extremes of a recording or refit by several copies of its noise.
  [[nodiscard]] std::vector<double> thinned_values(const PathMatrix& x,
                                                   std::span<const PathMatrix> copies) const;
  /// Spread of deviations among the third of refits with most noise over that with least.
  [[nodiscard]] double doubt(const std::vector<double>& deviations) const;
  /// Deviations of `by_less` get what repetitions that differ add, as far as noise does not.
  void add_wander(std::uint64_t seed, std::uint64_t stream);
};

}  // namespace kinemark::analysis::internal
