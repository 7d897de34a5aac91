// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// Smooth one marker by the integrated Wiener process, chosen by SURE (kalman) or cross-validation (gcv).
/// `result` has marker, state and the counts of the account filled in; the rest is written here.
void smooth_kalman(const MarkerSamples& samples, const data::Trajectories& in, const SmoothOptions& options,
                   MarkerResult& result);

}  // namespace kinemark::trajectory::smoothing
