// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/workflow/rig/calibrate.h"

namespace kinemark::pipeline {

/// What `kinemark calibrate` is asked to do.
struct CalibrateJob : JobSettings {
  /// Recordings of known things. The metadata entry "calibration" of each gives its kind: "tree"
  /// (frames_per_pose, sides_m), "grid" (nodes, spacing_m, distance_m; one camera each) or "scan"
  /// (frames_per_place, places_m).
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path nominal;       ///< rig as set up by hand, rig.toml
  std::filesystem::path output;        ///< rig.toml to write
  std::filesystem::path report;        ///< page to write as well, .html
  workflow::CalibrateOptions options;  ///< its progress is not looked at
  std::vector<double> sides_m;         ///< of the tree; empty: as the recording says
  int frames_per_pose = 0;             ///< 0: as the recording says
};

/// What `kinemark calibrate` found.
struct CalibrateOutcome : JobOutcome {
  workflow::CalibrateMethod method = workflow::CalibrateMethod::bundle;  ///< as asked
  bool has_rig = false;                             ///< a rig was found and is the first file that is written
  std::optional<calibration::BundleReport> bundle;  ///< as workflow::Calibrated
  std::optional<calibration::Alignment> alignment;  ///< likewise
};

/// Calibrate and write the rig. A model of the cameras that the recordings contradict misses the gate
/// "chi2_per_dof", whose sentence says why: then nothing is written. Fails as the readers and
/// workflow::calibrate(), and with Code::bad_input for a recording that does not say what it shows.
/// Progress counts steps.
[[nodiscard]] Result<CalibrateOutcome> run_calibrate(const CalibrateJob& job);

/// "method", by bundle and scan chi2_per_dof, warp_degree, crosstalk, iterations, poses, sightings, outliers,
/// side_rms_mm and "alignment" (cameras, aligned, next), "written" unless only the alignment was asked, and
/// "warnings".
[[nodiscard]] nlohmann::ordered_json calibrate_json(const CalibrateOutcome& outcome);

}  // namespace kinemark::pipeline
