// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Put into the covariance and the SDs of derivatives what the filter took from the movement at an impact.
///
/// A cut-off that suits the movement as a whole rounds a sudden stop off, and the residual has one sign
/// there. Where its mean over a quarter of a period of the cut-off is beyond what noise of the account's size
/// gives (chi-square of three axes, p < 1e-5), the square of that mean, less what noise adds, is added to the
/// variance within a quarter of a period on either side; to that of derivatives with a factor (2 pi
/// cut-off)^2 for each order. Needs the account's noise and cut-off; without them nothing changes. O(frames x
/// frames in a period).
void add_local_bias(const MarkerSamples& samples, MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
