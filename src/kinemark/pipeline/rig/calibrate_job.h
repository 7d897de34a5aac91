// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/calibration/bundle.h"

namespace kinemark::pipeline {

/// Inputs and options of `kinemark calibrate`.
struct CalibrateJob {
  /// How the rig is calibrated.
  enum class Method : std::uint8_t { bundle, grid_lut, scan };

  /// Recordings of known things. The metadata entry "calibration" of each gives its kind: "tree"
  /// (frames_per_pose, sides_m), "grid" (nodes, spacing_m, distance_m; one camera each) or "scan"
  /// (frames_per_place, places_m).
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path nominal;      ///< rig as set up by hand, rig.toml
  std::filesystem::path output;       ///< rig.toml to write
  Method method = Method::bundle;     ///< how the rig is calibrated
  calibration::BundleOptions bundle;  ///< for Method::bundle
  std::vector<double> sides_m;        ///< of the tree; empty: as stored in the recording
  int frames_per_pose = 0;            ///< 0: as stored in the recording
  bool align_only = false;  ///< report the deviation of the cameras from the nominal rig; write nothing
  bool force = false;       ///< replace a file that exists
};

/// Calibrate and write the rig. Returns what was found: method, written, warnings, and by bundle and scan
/// chi2_per_dof, warp_degree, crosstalk, iterations, poses, sightings, outliers, side_rms_mm, alignment.
[[nodiscard]] Result<nlohmann::ordered_json> calibrate_rig_file(const CalibrateJob& job,
                                                                const Progress& progress = {});

}  // namespace kinemark::pipeline
