// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the errors of a motion do to one of its measures, from refits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/body/body_definitions.h"

namespace kinemark::analysis {

/// A refit and its number.
struct NumberedView {
  std::int64_t number = 0;  ///< from 0
  BodyView view;            ///< of it
};

/// One measure of the estimate, of the pilot and of refits. Extremes are thinned: on the estimate by the
/// noise of every refit, on a refit by that of those beside it.
class MeasureErrors {
 public:
  /// @param smoothed_pilot  the pilot as refits have it without errors
  MeasureErrors(const BodyDefinition& definition, const BodyView& estimate, const BodyView& pilot,
                const BodyView& smoothed_pilot, std::int64_t refits);

  /// Refits that are there at once; those that are never given do not determine the measure.
  void add(std::span<const NumberedView> refits);

  /// Of the estimate, without the luck of the largest where it is an extreme.
  [[nodiscard]] double value() const;
  /// By refit: the measure less that of the pilot; NaN where it does not determine it.
  [[nodiscard]] const std::vector<double>& deviations() const { return deviations_; }

  /// How far the instant may lie from the estimate's, s; that it can be told from others is not said.
  struct Reach {
    double before = 0.0, after = 0.0;  ///< not positive, not negative
  };
  /// Of an instant: samples that are as extreme within three times the deviation of the difference.
  [[nodiscard]] Reach reach() const;

 private:
  const BodyDefinition& definition_;
  double rate_hz_, estimate_, truth_;
  Eigen::VectorXd curve_, without_noise_;
  std::optional<InstantSet> instants_;
  double thinned_ = 0.0, thinned_count_ = 0.0;
  std::vector<double> deviations_;
};

}  // namespace kinemark::analysis
