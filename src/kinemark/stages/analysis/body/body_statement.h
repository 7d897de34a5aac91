// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is said of one measure of a motion: its value, its interval, or why there is none.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/body/body_measures.h"
#include "kinemark/stages/analysis/body/body_series.h"
#include "kinemark/stages/analysis/body/coordinate_smoother.h"
#include "kinemark/stages/analysis/body/measure_errors.h"
#include "kinemark/stages/analysis/path/pivot.h"

namespace kinemark::analysis {

/// Variance over that of its errors, beyond which something moves at all.
inline constexpr double kMovesAtAll = 0.25;

/// One number to compute: which definition, of which stretch, of whom.
struct BodySlot {
  const BodyDefinition* definition = nullptr;  ///< which
  const BodyStretch* stretch = nullptr;        ///< where
  Eigen::Index a = 0, b = 0;                   ///< coordinates
  data::Side side = data::Side::left;          ///< of the body
};

/// Says measures of one motion.
class BodyStatement {
 public:
  /// Of each coordinate; none: it does not move, or is determined too seldom.
  using Smoothers = std::vector<std::optional<CoordinateSmoother>>;

  /// @param smoothers       of each coordinate that moves and is determined often enough; must outlive this
  /// @param momentum_known  the angular momentum is known in all frames
  BodyStatement(const BodyRecord& record, const Smoothers& smoothers, const BodyMeasureOptions& options,
                bool momentum_known)
      : record_(record), smoothers_(smoothers), options_(options), momentum_known_(momentum_known) {}

  /// @param errors  what refits say; null: there are none
  [[nodiscard]] data::Measure state(const BodySlot& slot, double value, const MeasureErrors* errors) const;

 private:
  // How much of a stretch a coordinate is not determined in.
  struct Gaps {
    double share = 0.0;  // of the samples
    double longest_s = 0.0;
  };
  [[nodiscard]] Gaps gaps_in(const Eigen::MatrixX<bool>& known, Eigen::Index c,
                             const BodyStretch& stretch) const;
  [[nodiscard]] Gaps gaps_of(const BodySlot& slot) const;
  [[nodiscard]] std::vector<std::string> held_in(const BodyStretch& stretch) const;
  [[nodiscard]] bool below_noise(const BodySlot& slot) const;
  [[nodiscard]] std::string subject_of(const BodySlot& slot) const;
  [[nodiscard]] std::string method_of(const BodySlot& slot) const;
  [[nodiscard]] bool rests_on_smoothed(const BodySlot& slot) const;
  [[nodiscard]] bool errors_known(const BodySlot& slot) const;
  [[nodiscard]] std::string no_value(const BodySlot& slot, double value, const Gaps& gaps) const;
  [[nodiscard]] std::string no_interval(const BodySlot& slot, const Gaps& gaps) const;
  void put_interval(const BodySlot& slot, double found_value, const MeasureErrors& errors,
                    data::Measure& measure) const;
  void put_instant(const BodySlot& slot, const Pivoted& found, double value,
                   const MeasureErrors::Reach& reach, data::Measure& measure) const;
  [[nodiscard]] Pivoted pivot_of(const BodyDefinition& definition, double value,
                                 const std::vector<double>& deviations) const;

  const BodyRecord& record_;
  const Smoothers& smoothers_;
  const BodyMeasureOptions& options_;
  bool momentum_known_;
};

}  // namespace kinemark::analysis
