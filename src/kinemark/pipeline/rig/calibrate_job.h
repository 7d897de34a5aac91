// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/calibration/alignment.h"
#include "kinemark/stages/calibration/bundle.h"

namespace kinemark::pipeline {

/// What `kinemark calibrate` is asked to do.
struct CalibrateJob : JobSettings {
  /// How points come from counts.
  enum class Method : std::uint8_t { bundle, grid_lut, scan };

  /// Recordings of known things. The metadata entry "calibration" of each gives its kind: "tree"
  /// (frames_per_pose, sides_m), "grid" (nodes, spacing_m, distance_m; one camera each) or "scan"
  /// (frames_per_place, places_m).
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path nominal;      ///< rig as set up by hand, rig.toml
  std::filesystem::path output;       ///< rig.toml to write
  std::filesystem::path report;       ///< page to write as well, .html
  Method method = Method::bundle;     ///< how the rig is calibrated
  calibration::BundleOptions bundle;  ///< for Method::bundle
  std::vector<double> sides_m;        ///< of the tree; empty: as the recording says
  int frames_per_pose = 0;            ///< 0: as the recording says
  bool align_only = false;            ///< tell how far the cameras stand from the nominal rig; write nothing
};

[[nodiscard]] std::string_view method_name(CalibrateJob::Method method);  ///< "bundle", "grid-lut", "scan"

/// What `kinemark calibrate` found.
struct CalibrateOutcome : JobOutcome {
  CalibrateJob::Method method = CalibrateJob::Method::bundle;  ///< as asked
  std::optional<calibration::BundleReport>
      bundle;  ///< by bundle and scan, unless only the alignment is asked
  std::optional<calibration::Alignment> alignment;  ///< against the nominal rig, by bundle and scan
};

/// Calibrate and write the rig. A model of the cameras that the recordings contradict misses the gate
/// "chi2_per_dof", whose sentence says why: then nothing is written. Fails as the readers and the stages of
/// calibration/, and with Code::usage when a recording that the method needs is not among the inputs.
/// Progress counts steps.
[[nodiscard]] Result<CalibrateOutcome> run_calibrate(const CalibrateJob& job);

}  // namespace kinemark::pipeline
