// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/workflow/rig/reconstruct.h"

namespace kinemark::pipeline {

/// What `kinemark reconstruct` is asked to do.
struct ReconstructJob : JobSettings {
  std::filesystem::path recording;       ///< of counts
  std::filesystem::path rig;             ///< rig.toml
  std::filesystem::path output;          ///< markers: .c3d, .trc or .csv
  std::filesystem::path report;          ///< page to write as well, .html
  workflow::ReconstructOptions options;  ///< its threads are not looked at
};

/// What `kinemark reconstruct` made.
struct ReconstructOutcome : JobOutcome {
  workflow::ReconstructMethod method = workflow::ReconstructMethod::smoother;  ///< as asked
  std::int64_t frames = 0;                                                     ///< F
  workflow::Reconstructed found;  ///< positions, and how they came
};

/// Points of a recording of counts as markers. Fails as the readers and workflow::reconstruct().
[[nodiscard]] Result<ReconstructOutcome> run_reconstruct(const ReconstructJob& job);

/// "method", "frames", "written", "warnings" and "leds": for each name, frames, located, occluded, saturated,
/// inconsistent, near_edge, light (of the calibration's LEDs), light_sd, light_source (LightSource),
/// strength_counts (per camera, but for the classic method), and by the smoother order, cutoff_hz,
/// chi2_per_dof, rejected, held_down, flicker_counts (per camera).
[[nodiscard]] nlohmann::ordered_json reconstruct_json(const ReconstructOutcome& outcome);

}  // namespace kinemark::pipeline
