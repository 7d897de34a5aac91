// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of feet and of movements, as tables and in recordings.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::pipeline {

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
