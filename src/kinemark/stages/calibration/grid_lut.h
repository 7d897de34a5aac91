// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The 1986 calibration: a plane grid of LEDs hung square before each camera.
#pragma once

#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::calibration {

/// The grid as it was built and hung.
struct GridGeometry {
  int nodes = 15;                 ///< along each side, 3 or more
  double spacing_m = 1.0 / 14.0;  ///< between neighbours, > 0
  double distance_m = 3.0;        ///< from the lens
};

/// Means of the counts of every LED of a grid before camera `camera` of the rig.
///
/// @param counts  of that camera alone; LED i * nodes + j is node (i, j), i to the camera's right, j down
/// Fails when the number of LEDs is not nodes x nodes, when more than a tenth of them is dark, and when the
/// grid was seen from behind or turned: its ratios must grow along both sides.
[[nodiscard]] Result<GridObservations> grid_observations(const data::Counts& counts, const data::Rig& rig,
                                                         int camera, const GridGeometry& geometry = {},
                                                         const StillOptions& options = {});

/// The nominal rig with a look-up table in each camera and poses as set by hand; method "grid-lut". Fails
/// when a node was not seen.
[[nodiscard]] Result<data::Rig> calibrate_grid_lut(const data::Rig& nominal,
                                                   const std::vector<GridObservations>& grids);

}  // namespace kinemark::calibration
