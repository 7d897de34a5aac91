// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "kinemark/pipeline/rig/reconstruct_job.h"

namespace kinemark::pipeline {

/// "method", "frames", "written", "warnings" and "leds": for each name, frames, located, occluded, saturated,
/// inconsistent, near_edge, light (of the calibration's LEDs), light_sd, light_source (LightSource),
/// strength_counts (per camera, but for the classic method), and by the smoother order, cutoff_hz,
/// chi2_per_dof, rejected, held_down, flicker_counts (per camera).
[[nodiscard]] nlohmann::ordered_json reconstruct_json(const ReconstructOutcome& outcome);

}  // namespace kinemark::pipeline
