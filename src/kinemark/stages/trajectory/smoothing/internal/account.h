// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Fill in what the residuals show: their size, autocorrelation, whiteness and spectrum, and the words about
/// them. Ljung & Box (1978), Biometrika 65(2):297-303.
void judge_residuals(const MarkerSamples& samples, double rate_hz, MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
