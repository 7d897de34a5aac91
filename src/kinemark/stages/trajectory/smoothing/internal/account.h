// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Fill in size, autocorrelation, whiteness and spectrum of the residuals, and their description. Ljung & Box
/// (1978), Biometrika 65(2):297-303.
void judge_residuals(const MarkerSamples& samples, double rate_hz, MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
