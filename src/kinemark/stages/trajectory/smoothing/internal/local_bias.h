// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Put into the covariance and the SDs of derivatives what the filter took from the movement at an impact.
///
/// A velocity that jumps (a heel that strikes) is rounded off by any filter, in a pattern that follows from
/// its response alone. The size of that pattern in the residual is estimated about each frame. Sizes of all
/// frames are noise, or noise and jumps for a share of the frames: share and variance of jumps are the
/// likeliest ones of the marker (EM), and nothing is added where they are not e^5 times likelier than noise
/// alone. The expected square of the size, times the pattern squared, is added to the variance; to that of
/// derivatives with a factor (2 pi cut-off)^2 for each order. Needs the account's noise and cut-off; without
/// them nothing changes. O(frames x frames in the pattern).
/// @param response  of the filter to a 1 among zeros, in the middle of an odd number of frames; empty:
/// nothing
///                  changes
void add_local_bias(const MarkerSamples& samples, std::span<const double> response, MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
