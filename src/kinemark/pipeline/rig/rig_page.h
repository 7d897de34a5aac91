// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/pipeline/rig/calibrate_job.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"

namespace kinemark::pipeline {

/// HTML of a calibration: what stands out, the cameras in space, where they stand and where they were meant
/// to, what to turn.
/// @param found  the rig as calibrated, or the nominal one where nothing was found
[[nodiscard]] std::string calibrate_page(const CalibrateJob& job, const CalibrateOutcome& outcome,
                                         const data::Rig& nominal, const data::Rig& found);

/// HTML of a reconstruction: what stands out, cameras, rays and points in space, what became of each LED, and
/// how the standard deviation depends on the place.
[[nodiscard]] std::string reconstruct_page(const ReconstructJob& job, const ReconstructOutcome& outcome,
                                           const data::Rig& rig, const data::Trajectories& points);

}  // namespace kinemark::pipeline
