// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/calibration/bundle.h"
#include "kinemark/stages/simulation/rig_calibration.h"
#include "kinemark/stages/simulation/rig_physics.h"

namespace kinemark::studies {

/// How a rig of the study is drawn and calibrated.
struct CalibratedRigOptions {
  simulation::RigDrawOptions rig;
  simulation::GridOptions grid;
  int tree_poses = 300;
  double intensity = 1.0;  ///< of the tree's LEDs; the grid's are always whole
  bool grid_in_bundle = true;
  calibration::BundleOptions bundle;
};

/// One simulated rig, calibrated by both methods from the same recordings.
struct CalibratedRig {
  simulation::PhysicalRig physical;
  data::Rig classic;                 ///< look-up tables, poses set by hand
  calibration::BundleResult bundle;  ///< rig and report
  double bundle_s = 0.0;             ///< time that the bundle took
  /// Rigid motions that take each method's world onto the true one, found on the tree's poses: the study
  /// compares lengths and shapes, since no method can determine the laboratory frame.
  math::SE3 truth_from_ours, truth_from_classic;
};

/// Draw rig `seed`, record grid and tree, calibrate.
[[nodiscard]] Result<CalibratedRig> calibrate_rig(std::uint64_t seed, CalibratedRigOptions options = {});
/// The same with a rig that is there.
[[nodiscard]] Result<CalibratedRig> calibrate_rig(simulation::PhysicalRig physical,
                                                  const CalibratedRigOptions& options = {});

}  // namespace kinemark::studies
