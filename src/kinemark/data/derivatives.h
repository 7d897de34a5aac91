// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::data {

/// The filter that one marker went through.
struct FilterUsed {
  std::string method;  ///< "kalman", "butterworth", "gcv", "savgol", "classic", "none"
  int order = 0;       ///< of the method: integrations of the Wiener process, half order of the spline, poles
  double cutoff_hz = 0.0;   ///< -3 dB of the whole filter; NaN where it has none
  double noise_sd_m = 0.0;  ///< per axis, of the samples that went in; NaN when unknown
};

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
