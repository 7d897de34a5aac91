// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One LED on a motor stage that visits known positions: automatic calibration.
#pragma once

#include <Eigen/Core>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/bundle.h"

namespace kinemark::calibration {

/// Positions at which the stage held the LED.
struct ScanPositions {
  Eigen::Matrix3Xd x_in_stage;   ///< m; a column per position, twelve or more
  int frames_per_position = 10;  ///< recorded at each position, >= 1
};

/// The positions as one rigid object with as many LEDs in a single pose, the input of calibrate_bundle().
/// Positions that a camera did not see, or where the LED moved, are left out for that camera. Fails when the
/// recording has more
/// than one LED, more frames than the positions, or fewer than twelve whole positions; positions that were
/// not visited any more are left out.
[[nodiscard]] Result<StillPoses> scan_observations(const data::Counts& counts, const data::Rig& rig,
                                                   const ScanPositions& positions,
                                                   const StillOptions& options = {});

/// Bundle over the scan: cameras and the pose of the stage; method "scan". The stage's own error (25 um moves
/// a count by 0.06) is not modelled. Fails as calibrate_bundle().
[[nodiscard]] Result<BundleResult> calibrate_scan(const data::Rig& nominal, const data::Counts& counts,
                                                  const ScanPositions& positions,
                                                  const BundleOptions& options = {},
                                                  const Progress& progress = {});

}  // namespace kinemark::calibration
