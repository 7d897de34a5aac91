// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

namespace kinemark::trajectory::smoothing {

/// A cut-off that is good for positions lets too much noise into derivatives where the movement ends below
/// it. This one weighs both: the geometric mean of cutoff_hz, best for positions, and of the cut-off with the
/// least estimated error of velocity, searched around it. That estimate is Stein's again, inside a wider
/// band in which movement and noise can be told apart: mean (v_wide - v)^2 + 2 sigma^2 dt / pi integral of
/// w^2 H H_wide dw. O(10 filters).
/// @param noise_sd_m  > 0, of a sample of variance 1
[[nodiscard]] double refine_cutoff(std::span<const Series> parts, int order, double cutoff_hz,
                                   double noise_sd_m);

}  // namespace kinemark::trajectory::smoothing
