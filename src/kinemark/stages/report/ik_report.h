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

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/cycle_overlay.h"
#include "kinemark/stages/report/ik_summary.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report {

/// What the page shows. The arrays are borrowed and must outlive the calls.
struct IkReport {
  IkSummary summary;                          ///< from summarize() of the same arrays
  const data::JointMotion* motion = nullptr;  ///< must be set
  const data::Trajectories* markers =
      nullptr;  ///< states for the gap map; nullptr: seen or not, from the errors
  /// Positions of `markers` are in the model's axes, so that the space view can show both.
  bool in_model_axes = true;
  std::optional<Eigen::Vector3d> up;    ///< against the model's gravity, length 1; none: the page finds it
  const SceneBodies* bodies = nullptr;  ///< of the model in this motion; nullptr: not known
  std::vector<CycleOverlay> cycles;     ///< of its coordinates; empty: no events mark any
};

/// The data that the page draws: `{"summary": summary_json(), "series": {...}}`.
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
