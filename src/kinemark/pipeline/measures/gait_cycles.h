// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Angles over the course of walking cycles, as a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trial.h"
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

/// One row for each curve, cycle and point, and of the mean: file, curve, context, cycle (1, 2, ... or
/// "mean"), percent, value, sd (of the value; of the mean: between cycles), unit. RFC 4180.
[[nodiscard]] std::string curves_csv(const std::vector<data::CycleCurves>& curves, const std::string& file);

}  // namespace kinemark::pipeline
