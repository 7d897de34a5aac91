// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "kinemark/pipeline/rig/calibrate_job.h"

namespace kinemark::pipeline {

/// "method", by bundle and scan chi2_per_dof, warp_degree, crosstalk, iterations, poses, sightings, outliers,
/// side_rms_mm and "alignment" (cameras, aligned, next), "written" unless only the alignment was asked, and
/// "warnings".
[[nodiscard]] nlohmann::ordered_json calibrate_json(const CalibrateOutcome& outcome);

}  // namespace kinemark::pipeline
