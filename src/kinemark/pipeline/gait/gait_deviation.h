// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How far walking is from a norm: Movement Analysis Profile and Gait Profile Score.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

/// The root mean square over the cycle of what a mean curve differs from the norm's mean.
struct GaitVariableScore {
  std::string title;                            ///< of its panel
  std::array<double, 2> value_deg{kNaN, kNaN};  ///< left, right; NaN: not known at every point
};

/// Baker et al. 2009 (Gait & Posture 30:265-269). `scores` is the Movement Analysis Profile, as far as there
/// are curves and norms. The Gait Profile Score of a side is the root mean square of nine scores: pelvic
/// tilt, obliquity and rotation, hip flexion, adduction and rotation, knee flexion, ankle dorsiflexion, foot
/// progression; that of both sides is of fifteen, the pelvis counted once, from the left cycle. The paper
/// takes 51 points of the cycle, here are those of the curves.
struct GaitDeviation {
  std::vector<GaitVariableScore> scores;       ///< in the order of the nine; empty: no norm has means
  std::array<double, 2> side_deg{kNaN, kNaN};  ///< left, right; NaN: one of the nine is not known
  double both_deg = kNaN;                      ///< NaN: one of the fifteen is not known
  std::vector<std::string> lacking;            ///< titles of those of the nine that are not known
};

/// Of a sheet with norms; without a mean curve in them it is empty.
[[nodiscard]] GaitDeviation gait_deviation(const GaitSheet& sheet);

}  // namespace kinemark::pipeline
