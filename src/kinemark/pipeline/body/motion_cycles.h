// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion of a model over walking cycles.
#pragma once

#include <span>
#include <vector>

#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/workflow/motion/dynamics.h"

namespace kinemark::pipeline {

/// Coordinates that move by themselves, with their deviations; where torques are known, moments along those
/// that are angles of joints ("knee_angle_r_moment") and their powers ("knee_angle_r_power"). A value that
/// the markers do not determine is missing.
/// @param measured  on the clock of the cycles
void add_motion_cycles(const workflow::MotionMeasured& measured, std::span<const analysis::GaitCycle> cycles,
                       std::vector<SheetInput>& out);

}  // namespace kinemark::pipeline
