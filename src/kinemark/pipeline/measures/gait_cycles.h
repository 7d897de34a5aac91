// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Curves over the course of cycles, as a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"

namespace kinemark::pipeline {

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

}  // namespace kinemark::pipeline
