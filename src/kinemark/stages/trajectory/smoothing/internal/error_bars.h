// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Correction of the smoother's error bars from the residuals.
#pragma once

#include <array>
#include <span>

#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

namespace kinemark::trajectory::smoothing {

/// Factors on variances, by derivative (position first).
struct BarScale {
  std::array<double, 4> seen{1.0, 1.0, 1.0, 1.0};   ///< where samples are all around
  std::array<double, 4> added{1.0, 1.0, 1.0, 1.0};  ///< on what gaps and ends add to that
  std::array<double, 4> interior{};  ///< least variance of the model: what "all around" means, noise units
};

/// Scale the model's variances to the residuals of the data.
///
/// Seen samples: the model assumes that half of the signal removed at the corner frequency is movement. A
/// second run with a wider band measures the true share. Gaps and ends: stretches as long as the gaps of this
/// recording
/// (about one time constant when it has none) are hidden, and the smoothed values there are compared with
/// those from the complete data. For short recordings both factors are shrunk towards usual values.
/// @param noise_sd_m  > 0, of a sample of variance 1
[[nodiscard]] BarScale scale_bars(std::span<const Series> parts, int order, double cutoff_hz,
                                  double noise_sd_m);

}  // namespace kinemark::trajectory::smoothing
