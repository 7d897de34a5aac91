// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Self-calibration of lateral-effect cameras from an object of known size that was held still in many poses.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::calibration {

/// Prior standard deviations of the parameters.
struct BundlePriors {
  double rotation_rad = 0.05;       ///< about each axis
  double centre_m = 0.060;          ///< of the lens, each axis
  double focal_share = 0.04;        ///< of the nominal focal length
  double principal_point = 0.06;    ///< half-sides
  double warp = 0.02;               ///< each coefficient, half-sides
  double crosstalk = 0.02;          ///< each coefficient
  double gain = 0.01;               ///< of each channel
  double offset_counts = 12.0;      ///< of each channel
  double grid_led_m = 0.5e-3;       ///< placement of each LED on the grid
  double grid_rotation_rad = 0.02;  ///< about each axis
  double grid_centre_m = 5e-3;      ///< across the axis
  double grid_distance_m = 12e-3;   ///< along it
};

/// Options of the bundle adjustment.
struct BundleOptions {
  int warp_degree = 10;          ///< 2 to 12; the model begins here ...
  bool crosstalk = true;         ///< ... with the twelve terms between electrodes
  bool escalate = true;          ///< ... and grows two degrees at a time while chi2/dof is above `enough`
  int highest_warp_degree = 12;  ///< up to 12
  double enough = 1.2;           ///< chi2/dof at which the model is rich enough
  double refuse_above = 1.5;     ///< chi2/dof at which the calibration is refused
  int max_iterations = 30;       ///< >= 1, of each model
  double largest_outlier_share = 0.02;  ///< of the observations: the gate on chi2/dof leaves out that many
  BundlePriors priors;                  ///< spread of what is believed before

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// What the bundle found, beside the rig.
struct BundleReport {
  double chi2_per_dof = 0.0;        ///< outliers left out
  int warp_degree = 0;              ///< of the model that was kept
  bool crosstalk = false;           ///< whether it has the terms between electrodes
  int iterations = 0;               ///< of all models together
  int poses = 0, observations = 0;  ///< used
  int outliers = 0;                 ///< observations that the robust weights hold down to a third or less
  std::vector<math::SE3> world_from_tree;  ///< per pose
  double side_rms_m =
      0.0;  ///< root mean square of tree sides, triangulated without the tree, against the given
};

/// A calibrated rig and how it came about.
struct BundleResult {
  data::Rig rig;        ///< parameters, joint covariance and chi2/dof; method "bundle"
  BundleReport report;  ///< fit, outliers, what was tried
};

/// Bundle adjustment over cameras, channels and the poses of a tree of LEDs; the grid of each camera joins
/// when it is given.
///
/// Maximum a posteriori: counts of an observation are S phi(point; camera) + offset, the source's strength S
/// eliminated in closed form; each pose and each grid LED is eliminated by a Schur complement. The world
/// stays where `nominal` has the first camera; covariance is given in the gauge that fixes the cloud of tree
/// LEDs.
///
/// Fails when fewer than four poses (of an object of twelve LEDs or more: one) are seen by two cameras, when
/// the tree's sides do not fit what is seen, and when chi2/dof of the richest model is above `refuse_above`.
/// Cost: 300 poses, degree 10: about 1 s. Theory: docs/theory/calibration.md
[[nodiscard]] Result<BundleResult> calibrate_bundle(const data::Rig& nominal, const StillPoses& tree,
                                                    const std::vector<GridObservations>& grids,
                                                    const BundleOptions& options = {},
                                                    const Progress& progress = {});

}  // namespace kinemark::calibration
