// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/filter_used.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::data {

/// Rates of change of Trajectories: F x M x 3, laid out like x_in_world; NaN where there is no position or no
/// estimate. Each `_sd` is one standard deviation per axis, same shape, or empty when the method has none.
struct Derivatives {
  Array<double> velocity, velocity_sd;          ///< m/s
  Array<double> acceleration, acceleration_sd;  ///< m/s^2
  Array<double> jerk, jerk_sd;                  ///< m/s^3; empty when not asked
  std::vector<FilterUsed> filters;              ///< M

  /// Shapes agree with those of `of`; standard deviations are not negative. O(F M).
  [[nodiscard]] Status validate(const Trajectories& of) const;
};

}  // namespace kinemark::data
