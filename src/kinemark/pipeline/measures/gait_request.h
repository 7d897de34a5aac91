// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Walking as a part of the job of measures.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/gait/gait_report.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::pipeline {

/// What is asked about walking, and which events and cycles are written. Paths that are empty are not used.
struct GaitRequest {
  std::string events =
      "best";  ///< whose: "best", "plates", "kinematics", "file"; "movement": the markers' own
  std::vector<std::string> markers;    ///< ROLE=NAME, or a .toml of lines like role = "NAME"
  std::filesystem::path write_events;  ///< .csv, or .c3d or .nwb: the recording with these events
  std::filesystem::path angles;        ///< .mot or .sto of coordinates, whose cycles are written and drawn
  std::filesystem::path write_cycles;  ///< .csv: curves over the cycle
  GaitReportRequest sheet;             ///< norms and pairs of a gait report

  /// Whether walking is asked about by more than being there.
  [[nodiscard]] bool wanted() const {
    return (events != "best" && !of_movement()) || !markers.empty() || !angles.empty() ||
           !sheet.norms.empty() || !sheet.angle_angle.empty();
  }
  /// Whether events and cycles are those of the markers' own movements, even where feet step.
  [[nodiscard]] bool of_movement() const { return events == "movement"; }
  /// Whether events or cycles are written.
  [[nodiscard]] bool writes() const { return !write_events.empty() || !write_cycles.empty(); }
  /// Whether events are written into a recording.
  [[nodiscard]] bool into_recording() const;
  /// Names and endings: Code::usage.
  /// @param drawn  whether figures or a page are made: else norms and pairs have no use
  [[nodiscard]] Status check(bool drawn = false) const;
  /// The same where nothing of walking is written or drawn: then nothing may be asked about it.
  [[nodiscard]] Status check_idle() const;
};

/// What of walking is written and drawn. Paths that are empty are not used.
struct GaitOutputs {
  GaitRequest gait;               ///< whose events, norms, pairs; files of events and cycles
  std::filesystem::path figures;  ///< folder for figures
  std::string figure_formats;     ///< as parse_figure_formats(); empty: all that this program can write
  std::filesystem::path report;   ///< page, .html
};

/// The files that the request reads: roles of markers, angles with what lies beside them, norms. Names of no
/// file may be among them.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const GaitRequest& request);

/// The options of analysis::analyze_gait() for what is asked: roles read, choice understood.
/// @param drawn  as GaitRequest::check()
[[nodiscard]] Result<analysis::GaitOptions> gait_options(const GaitRequest& request, bool drawn = false);

/// "type" (walk, run, sprint), "direction" (forward, backward, sideways,
/// unknown), "turning_deg", "turning", "speed" (mm/s over the ground or belt), "stride_time_s", "person"
/// (null: one), "plates_out_of_step", "treadmill", "belt_speed" (mm/s; null over ground), "events".
[[nodiscard]] nlohmann::ordered_json gait_json(const analysis::Gait& gait);

/// For people: each event with its SD and source.
[[nodiscard]] std::string events_text(const analysis::Gait& gait);

}  // namespace kinemark::pipeline
