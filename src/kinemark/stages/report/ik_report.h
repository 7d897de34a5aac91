// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The report of a solved trial: one self-contained HTML page that opens without a network.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/cycle_overlay.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report {

/// One inertial sensor that took part.
struct SensorRow {
  std::string name;                   ///< in the recording
  std::string body;                   ///< of the model, that carries it
  std::string placed_by;              ///< what says how it stands there: "pose", "model" or "markers"
  std::int64_t rejected_samples = 0;  ///< left out, of the frames solved
};

/// Inertial sensors that a motion follows: S sensors on its F frames.
struct ReportSensors {
  std::vector<SensorRow> rows;           ///< S
  Array<double> error_rad;               ///< F x S, angle between measured and model; NaN: not used
  std::vector<data::SampleState> state;  ///< F x S
  double heading_rad = 0.0;              ///< of the sensors' world about the vertical
  double heading_sd_rad = 0.0;           ///< 0: given
  std::string heading_from;              ///< what it follows from: "motion", "facing axis", ...
  double pose_drift_rad = 0.0;           ///< largest turn of a sensor within the pose that places it
  double noise_sd_rad = kNaN;            ///< of an orientation about each axis; NaN: not known
};

/// What the page shows. The arrays are borrowed and must outlive the calls.
struct IkReport {
  IkSummary summary;                          ///< from summarize() of the same arrays
  const data::JointMotion* motion = nullptr;  ///< must be set
  const data::Trajectories* markers =
      nullptr;  ///< states for the gap map; nullptr: seen or not, from the errors
  /// Positions of `markers` are in the model's axes, so that the space view can show both.
  bool in_model_axes = true;
  std::optional<Eigen::Vector3d> up;       ///< against the model's gravity, length 1; none: the page finds it
  const ReportSensors* sensors = nullptr;  ///< in place of markers or beside them; nullptr: none
  const SceneBodies* bodies = nullptr;     ///< of the model in this motion; nullptr: not known
  std::vector<CycleOverlay> cycles;        ///< of its coordinates; empty: no events mark any
};

/// The data that the page draws: `{"summary": summary_json(), "series": {...}}`. Without markers space shows
/// the bodies and, in the middle of each that carries one, its sensor.
///
/// Series are little-endian float32 (deg or m, mm) or uint8 in base64. A recording with more frames than
/// points is thinned so that the smallest and largest value and the largest standard deviation of each
/// stretch are kept
/// (`frame_step` > 1). Values of undetermined coordinates are left out, not interpolated.
/// O(F (n + M)) time; the result is bounded by the options whatever the length of the recording.
[[nodiscard]] nlohmann::ordered_json report_json(const IkReport& report, const ReportOptions& options = {});

/// The whole page. Equal reports give equal bytes: it holds no time of day and no machine name.
/// Names and sentences may hold any bytes: they cannot end the data block and are shown as text only.
[[nodiscard]] std::string report_html(const IkReport& report, const ReportOptions& options = {});

}  // namespace kinemark::report
