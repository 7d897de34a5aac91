// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments' results as tables, as a trial, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/data/table.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::pipeline {

/// Angles, then values, a column each: "LKneeAngles_flexion"; degrees and metres.
[[nodiscard]] data::Table angles_table(const analysis::SegmentMotion& motion);
/// One standard deviation of each, in a table of the same shape.
[[nodiscard]] data::Table angle_deviations_table(const analysis::SegmentMotion& motion);

/// Each column of angles_table() as a series with its deviations, in SI units.
[[nodiscard]] std::vector<analysis::CycleSeries> angle_series(const analysis::SegmentMotion& motion);

/// The same in long form (RFC 4180): time_s, name, component, value, sd, unit, state; a line each, missing
/// ones too.
[[nodiscard]] std::string angles_csv(const analysis::SegmentMotion& motion);

/// The points as a trial's markers, on the recording's frames.
[[nodiscard]] data::Trial points_trial(const analysis::SegmentMotion& motion, const data::Trial& recording);
/// The recording with the angles among its channels, in degrees, and the points among its markers; what of
/// the recording has the name of a result makes room for it.
[[nodiscard]] data::Trial trial_with(const analysis::SegmentMotion& motion, data::Trial recording);

/// Measures of the subject: a list of "name", "value", "unit", "sd" (null: not known), "from".
[[nodiscard]] nlohmann::ordered_json parameters_json(const analysis::SegmentMotion& motion);
/// Angles and values: a list of "name", "components", "unit", and how many frames are "measured",
/// "interpolated" and "missing", with the root mean square of the deviations ("sd").
[[nodiscard]] nlohmann::ordered_json series_json(const analysis::SegmentMotion& motion);

}  // namespace kinemark::pipeline
