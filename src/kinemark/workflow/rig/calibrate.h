// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A rig from counts of things of known size, in memory.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/alignment.h"
#include "kinemark/stages/calibration/bundle.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// A tree of three LEDs that is held still in one pose after the other.
struct ShownTree {
  std::vector<double> sides_m;  ///< between LEDs 1-2, 1-3 and 2-3
  int frames_per_pose = 0;      ///< > 0
};

/// A grid that one camera looks at.
struct ShownGrid {
  int nodes = 0;            ///< along each side
  double spacing_m = 0.0;   ///< between neighbours
  double distance_m = 0.0;  ///< from the camera
};

/// An LED that a stage moves to known places.
struct ShownScan {
  int frames_per_place = 0;     ///< > 0
  Eigen::Matrix3Xd x_in_stage;  ///< 3 x places, m
};

/// A recording of counts, and the thing of known size that it shows.
struct ShownCounts {
  std::string name;     ///< begins the sentences about it: a path, or what a program calls it
  data::Counts counts;  ///< as recorded
  std::variant<ShownTree, ShownGrid, ShownScan> shows;  ///< the thing, with its size
};

/// How a rig is calibrated.
enum class CalibrateMethod : std::uint8_t {
  bundle,    ///< tree, and grids where they are there: everything at once
  grid_lut,  ///< the table of 1986, of a grid before each camera
  scan,      ///< an LED on a stage
};
[[nodiscard]] std::string_view to_string(CalibrateMethod method);  ///< "bundle", "grid-lut", "scan"

/// Options of calibrate().
struct CalibrateOptions {
  CalibrateMethod method = CalibrateMethod::bundle;  ///< how the rig is calibrated
  calibration::BundleOptions bundle;                 ///< by bundle and scan
  bool align_only = false;  ///< how far cameras stand from the nominal rig, and no more
  Progress progress;        ///< counts steps
};

/// What calibrate() found.
struct Calibrated {
  /// Nothing: only the alignment was asked for, or the counts contradict the model of the cameras.
  std::optional<data::Rig> rig;
  std::optional<calibration::BundleReport>
      bundle;  ///< by bundle and scan, unless only the alignment is asked
  std::optional<calibration::Alignment> alignment;  ///< against the nominal rig, by bundle and scan
  Remarks remarks;  ///< what of the recordings is not used; the bound on chi2 per degree of freedom
};

/// Calibrate a rig. Of several trees, or scans, the last one counts. A model of the cameras that the counts
/// contradict misses the gate "chi2_per_dof", whose sentence says why; that is no failure.
///
/// @param nominal  the rig as it was set up by hand
/// Fails as the stages of calibration/, with Code::bad_input for a grid that is not of one camera of the rig,
/// and with Code::usage where what the method needs is not shown.
[[nodiscard]] Result<Calibrated> calibrate(std::span<const ShownCounts> shown, const data::Rig& nominal,
                                           const CalibrateOptions& options = {});

}  // namespace kinemark::workflow
