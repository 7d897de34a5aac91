// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What the residuals say about the smoother's own error bars.
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

/// Scale the model's variances to what the data show.
///
/// Seen samples: the model believes that half of what it cuts off at the corner is movement. A second run
/// with a wider band shows how much was. Gaps and ends: stretches as long as the gaps of this recording
/// (about one time constant when it has none) are hidden, and what the smoother then says there is compared
/// with what it says when it sees them. Both are drawn towards what is usual when a recording is short.
/// @param noise_sd_m  > 0, of a sample of variance 1
[[nodiscard]] BarScale scale_bars(std::span<const Series> parts, int order, double cutoff_hz,
                                  double noise_sd_m);

}  // namespace kinemark::trajectory::smoothing
