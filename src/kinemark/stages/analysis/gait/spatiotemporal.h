// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The spatiotemporal measures of walking: what each is.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/stages/analysis/path/pivot.h"

namespace kinemark::analysis {

/// What a measure is of.
enum class GaitScope : std::uint8_t {
  body,       ///< both feet together
  each_side,  ///< a value for each foot
};

/// What errors do to a measure.
enum class GaitError : std::uint8_t {
  moves,            ///< to either side
  raises,           ///< a deviation, which independent errors raise: its bias is that of its square
  raises_or_hides,  ///< likewise of times: a swing that lasts longer is cut short by as large a share, so
                    ///< that errors can go against what strides differ by
};

/// One spatiotemporal measure.
struct GaitDefinition {
  data::MeasureDefinition what;       ///< its line in `--list`
  GaitScope scope = GaitScope::body;  ///< whether left and right have values of their own
  GaitError error = GaitError::moves;
  /// Of cycles of one foot, or of both (body), in SI units; NaN where none tells.
  double (*value)(std::span<const GaitCycle> cycles) = nullptr;
  bool of_other = false;  ///< each_side: from the cycles of the other foot, within which this one steps

  [[nodiscard]] bool is_deviation() const { return error != GaitError::moves; }
  /// Value and interval from what refits differ by: of a deviation, its square.
  [[nodiscard]] Pivoted interval(double value, std::span<const double> deviations, double level) const;
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const GaitDefinition> gait_definitions();
/// One by its id, or nothing.
[[nodiscard]] const GaitDefinition* find_gait_definition(std::string_view id);

}  // namespace kinemark::analysis
