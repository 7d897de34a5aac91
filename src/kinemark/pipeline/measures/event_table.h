// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of feet and of movements, as tables and in recordings.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::pipeline {

// Curves over the course of cycles, as a table.

/// Curves of every angle over the cycles of its side: of the model outputs that the recording holds
/// ("LKneeAngles x"), and of the coordinates of a motion, with the deviations of the Q_sd.sto beside it. Left
/// and right are told by L... and R..., or ..._l and ..._r; other curves are cut by the cycles of both.
///
/// @param motion  .mot or .sto of coordinates on the recording's clock; empty: none
/// @return        Code::bad_input where there is no angle, or no cycle
[[nodiscard]] Result<std::vector<data::CycleCurves>> gait_curves(
    const data::Trial& trial, const std::vector<analysis::GaitCycle>& cycles,
    const std::filesystem::path& motion);

/// Curves of one stretch.
struct RegionCurves {
  std::string region;                     ///< its name; empty: the whole recording
  std::vector<data::CycleCurves> curves;  ///< of it
};

/// One row for each curve, cycle and point, and of the mean: file, participant, session, trial, subject,
/// curve, context, region, cycle (1, 2, ... or "mean"), percent, value, sd (of noise, of the value; of the
/// mean where all have one), sd_between (of the mean's rows: between cycles, N - 1), unit, and the columns of
/// the participants' table. RFC 4180.
[[nodiscard]] std::string curves_csv(const std::vector<RegionCurves>& curves, const RecordingName& recording);
/// Its first line alone.
[[nodiscard]] std::string curves_csv_columns(const RecordingName& recording);
/// Its other lines.
[[nodiscard]] std::string curves_csv_rows(const std::vector<RegionCurves>& curves,
                                          const RecordingName& recording);

/// An instant, its deviation, and who says so.
struct EventRow {
  std::string subject;     ///< marker that moves; empty: a foot
  std::string context;     ///< "Left", "Right", or empty
  std::string region;      ///< name of the stretch; empty: the whole recording
  std::string label;       ///< "Foot Strike", "Movement Start"
  double time_s = kNaN;    ///< on the recording's clock
  std::int64_t frame = 0;  ///< number in the file, of the nearest
  double sd_s = kNaN;      ///< one standard deviation; NaN: not known
  std::string source;      ///< "plate", "kinematics", "file"
  std::string method;      ///< "plate 1", "5 % of the peak speed"
};

/// Of feet.
[[nodiscard]] std::vector<EventRow> events_of(const analysis::Gait& gait, const TimeBase& time);
/// Of the markers' own movements, marker by marker.
[[nodiscard]] std::vector<EventRow> events_of(const std::vector<analysis::PathRhythm>& rhythms,
                                              const TimeBase& time);

/// One row each: file, participant, session, trial, subject, context, region, label, time_s, frame, sd_s,
/// source, method, and the columns of the participants' table. RFC 4180.
[[nodiscard]] std::string events_csv(const std::vector<EventRow>& events, const RecordingName& recording);
/// Its first line alone.
[[nodiscard]] std::string events_csv_columns(const RecordingName& recording);
/// Its other lines.
[[nodiscard]] std::string events_csv_rows(const std::vector<EventRow>& events,
                                          const RecordingName& recording);

/// The trial with these events instead of its own of the same kind: of feet, where these are, and of the same
/// labels; others stay. Events of no side are "General".
[[nodiscard]] data::Trial with_events(data::Trial trial, const std::vector<EventRow>& events);

/// What repeats in the paths: "subject", "region", "periodic", "period_s", "verdict", "events".
[[nodiscard]] nlohmann::ordered_json rhythms_json(const std::vector<analysis::PathRhythm>& rhythms);
/// The same for people.
[[nodiscard]] std::string rhythms_text(const std::vector<analysis::PathRhythm>& rhythms);

}  // namespace kinemark::pipeline
