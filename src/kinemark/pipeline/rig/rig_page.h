// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/rig.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/pipeline/rig/calibrate_job.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"

namespace kinemark::pipeline {

/// Median standard deviation (root of the trace of the covariance, m) of the points of each cell of a plane
/// of the world.
struct PrecisionMap {
  std::array<int, 2> axes{};           ///< of the world, along columns and along rows: 0, 1 or 2
  std::array<double, 2> first{};       ///< edges of the first cell, m
  double cell_m = 0.0;                 ///< side of a cell; 0: there is nothing to map
  std::int64_t columns = 0, rows = 0;  ///< cells along the two axes
  std::vector<double> sd_m;            ///< rows x columns, NaN where no point was
  std::vector<std::int64_t> samples;   ///< rows x columns
};

/// Of all present samples that have a covariance, seen along the world's axis `along`. Cells are the finest
/// of 1, 2 or 5 times a power of ten metres of which 24 cover the longer side.
[[nodiscard]] PrecisionMap precision_map(const data::Trajectories& points, int along);

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
