// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A motion of a model over walking cycles.
#pragma once

#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/pipeline/body/body_record.h"
#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"

namespace kinemark::pipeline {

/// Coordinates that move by themselves, with their deviations; where torques are known, moments along those
/// that are angles of joints ("knee_angle_r_moment") and their powers ("knee_angle_r_power"). A value that
/// the markers do not determine is missing. Fails as the mechanics of `input`.
/// @param motion  with rates, on the clock of the cycles
[[nodiscard]] Status add_motion_cycles(const data::JointMotion& motion, const BodyInput& input,
                                       std::span<const analysis::GaitCycle> cycles,
                                       std::vector<SheetInput>& out);

}  // namespace kinemark::pipeline
