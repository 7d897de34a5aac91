// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a gait report draws, as tables.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/pipeline/gait/angle_angle.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

/// All curves: quantity, curve, context, cycle (1, 2, ... or "mean"), percent, value, sd (of a mean: between
/// cycles), own_sd (by the measurement), cycles (that have a value), norm_low, norm_high, norm_mean, unit.
/// Units are those of the drawing. RFC 4180.
[[nodiscard]] std::string sheet_csv(const GaitSheet& sheet);

/// Means of pairs: x, y (keys), context, percent, x_mean, y_mean, x_sd, y_sd, correlation (between cycles),
/// cycles.
[[nodiscard]] std::string pairs_csv(std::span<const AnglePair> pairs);

/// One measure of left, right and both feet beside the norm.
struct MeasureRow {
  std::string title;                     ///< of its definition
  std::string region;                    ///< empty: the whole recording
  std::string unit;                      ///< as shown
  std::array<std::string, 3> value;      ///< left, right, both: "1.09 [1.08 to 1.10]"; empty: not there
  std::array<std::string, 3> judgement;  ///< "below", "within", "above" the norm, with what its interval
                                         ///< says; empty: no norm
  std::string norm;                      ///< "1.00 to 1.20"; left / right where these differ
};

/// Measures of walking in the order of their definitions.
[[nodiscard]] std::vector<MeasureRow> measure_rows(const GaitSheet& sheet);

}  // namespace kinemark::pipeline
