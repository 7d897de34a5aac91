// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments' results as tables, as a trial, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/data/table.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/kinetics/joint_loads.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::pipeline {

/// Series of one recording, none null.
using SeriesList = std::vector<const analysis::SegmentSeries*>;
[[nodiscard]] SeriesList series_of(const analysis::SegmentMotion& motion);  ///< angles, then values
[[nodiscard]] SeriesList series_of(const analysis::JointLoads& loads);      ///< as they are

/// A column each: "LKneeAngles_flexion"; degrees, metres, or the series' unit.
[[nodiscard]] data::Table series_table(const SeriesList& list, const TimeBase& time, const std::string& name);
/// One standard deviation of each, in a table of the same shape.
[[nodiscard]] data::Table deviations_table(const SeriesList& list, const TimeBase& time,
                                           const std::string& name);

/// The same in long form (RFC 4180): time_s, name, component, value, sd, unit, state; a line each, missing
/// ones too.
[[nodiscard]] std::string series_csv(const SeriesList& list, const TimeBase& time);

/// The points as a trial's markers, on the recording's frames.
[[nodiscard]] data::Trial points_trial(const analysis::SegmentMotion& motion, const data::Trial& recording);
/// The recording with the angles, in degrees, and the loads among its channels, and the points among its
/// markers; what of the recording has the name of a result makes room for it.
[[nodiscard]] data::Trial trial_with(const analysis::SegmentMotion& motion, const analysis::JointLoads& loads,
                                     data::Trial recording);

/// Measures of the subject: a list of "name", "value", "unit", "sd" (null: not known), "from".
[[nodiscard]] nlohmann::ordered_json parameters_json(const analysis::SegmentMotion& motion);
/// A list of "name", "components", "unit", and how many frames are "measured",
/// "interpolated" and "missing", with the root mean square of the deviations ("sd").
[[nodiscard]] nlohmann::ordered_json series_json(const SeriesList& list);

}  // namespace kinemark::pipeline
