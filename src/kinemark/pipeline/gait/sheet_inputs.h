// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Curves for a gait sheet from what jobs have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"
#include "kinemark/stages/analysis/gait/gait.h"

namespace kinemark::pipeline {

/// Curves in SI units as they are; those of one side alone whose cycles are none are left out.
void add_curves(const std::vector<data::CycleCurves>& curves, std::vector<SheetInput>& out);

/// A series cut at the strikes of the side that its name tells, else of both.
void add_series(const analysis::CycleSeries& series, std::span<const analysis::GaitCycle> cycles,
                const std::string& unit, std::vector<SheetInput>& out);

/// Moments and powers of hips, knees and ankles that a recording keeps among its channels, in the file's
/// units. Components that are 0 throughout are left out.
void add_kinetic_channels(const data::Trial& trial, std::span<const analysis::GaitCycle> cycles,
                          std::vector<SheetInput>& out);

/// The vertical force (N, up is positive) on each foot over the cycles whose strike a plate saw: of that
/// plate from the strike until the foot leaves, then 0; cycles that no plate saw are missing.
/// @param plates  on the recording's clock
/// @param up      of length 1
void add_ground_reaction(const data::Wrenches& plates, const Eigen::Vector3d& up, const analysis::Gait& gait,
                         std::vector<SheetInput>& out);

}  // namespace kinemark::pipeline
