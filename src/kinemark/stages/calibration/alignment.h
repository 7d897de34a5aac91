// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Deviation of the cameras from their nominal poses, and the next adjustment to make.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::calibration {

/// Options of compare_alignment() and align_by_tree(): how far a camera may stand from its wanted pose.
struct AlignmentOptions {
  double shift_tolerance_m = 2e-3;      ///< > 0, of the lens, each axis
  double rotation_tolerance_deg = 0.1;  ///< > 0, about each axis

  /// Tolerances are positive.
  [[nodiscard]] Status check() const;
};

/// One camera against the wanted pose, in the axes of the wanted camera: right, down, forward.
struct CameraAlignment {
  std::string camera;       ///< its name
  Eigen::Vector3d shift_m;  ///< lens, from the wanted position
  Eigen::Vector3d
      rotation_deg;  ///< rotation still needed: tilt up, pan to the right, roll clockwise as seen from behind
  Eigen::Vector3d shift_sd_m = Eigen::Vector3d::Zero(),
                  rotation_sd_deg = Eigen::Vector3d::Zero();  ///< 0: unknown
};

/// All cameras of a rig against their wanted poses.
struct Alignment {
  std::vector<CameraAlignment> cameras;  ///< in the order of the rig
  bool aligned = false;                  ///< everything is within tolerance
  std::string next;  ///< the next adjustment: the largest deviation relative to its tolerance
};

/// Compare two rigs of the same cameras. The world of `found` is first aligned with that of `wanted` by
/// lenses and optical axes: only the relative poses of the cameras matter. Standard deviations are those of
/// found.covariance.
[[nodiscard]] Result<Alignment> compare_alignment(const data::Rig& wanted, const data::Rig& found,
                                                  const AlignmentOptions& options = {});

/// The same from observations of the tree, by calibrate_bundle() without its grid: four poses will do, some
/// hundred give rotations to a tenth of a degree. Fails as calibrate_bundle(), but never refuses a misfit.
[[nodiscard]] Result<Alignment> align_by_tree(const data::Rig& wanted, const StillPoses& tree,
                                              const AlignmentOptions& options = {});

}  // namespace kinemark::calibration
