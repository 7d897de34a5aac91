// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Fill in size, autocorrelation, whiteness and spectrum of the residuals, and their description.
/// @param impulse_response  of the filter that was used, to a 1 in its middle; empty: there was none
void judge_residuals(const MarkerSamples& samples, std::span<const double> impulse_response, double rate_hz,
                     MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
