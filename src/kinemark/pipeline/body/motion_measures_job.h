// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a motion: of its joints, of the body, of how two coordinates move together.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/gait/gait_sheet.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "kinemark/pipeline/motion/motion_files.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/workflow/measures/asked.h"
#include "kinemark/workflow/motion/dynamics.h"

namespace kinemark::pipeline {

// A motion of a model over walking cycles.

/// Coordinates that move by themselves, with their deviations; where torques are known, moments along those
/// that are angles of joints ("knee_angle_r_moment") and their powers ("knee_angle_r_power"). A value that
/// the markers do not determine is missing.
/// @param measured  on the clock of the cycles
void add_motion_cycles(const workflow::MotionMeasured& measured, std::span<const analysis::GaitCycle> cycles,
                       std::vector<SheetInput>& out);

/// What `kinemark dynamics MOTION --model M` is asked to measure: ids of analysis::body_definitions(),
/// regions whose rows count from 1, between events in the .c3d of `forces` or found of its feet. The output
/// is a .csv, .json or .nwb.
struct MotionMeasuresJob : MotionFiles, workflow::MeasureChoice, GaitOutputs {
  std::vector<std::string> select;  ///< coordinates; * is any text, ? any letter; empty: all that can move
  std::vector<std::string> couple;  ///< "A,B": coordinates whose coupling is measured
  bool normalize = false;           ///< kinetics per mass, momentum over mass, speed and height
};

/// Warnings: what was left out or taken otherwise.
struct MotionMeasuresOutcome : JobOutcome {
  std::vector<data::InputFile> inputs;  ///< all that were read
  std::vector<data::Measure> measures;  ///< by stretch: coordinates, pairs, the body
};

/// Read, compute, measure, write (docs/stages/motion-measures.md). Progress counts nothing.
///
/// A gait report draws coordinates, and with forces or torques moments and powers along them. Where the
/// recording has no walking it is not there, which is a warning.
///
/// Code::usage for a measure, coordinate or region that is none, for events without a .c3d and for another
/// ending than .csv, .json and .nwb; Code::bad_input as the readers, regions_between() and
/// analysis::measure_body().
[[nodiscard]] Result<MotionMeasuresOutcome> run_motion_measures(const MotionMeasuresJob& job);

/// "inputs", "measures" (measures_json()), "written", "warnings".
[[nodiscard]] nlohmann::ordered_json motion_measures_json(const MotionMeasuresOutcome& outcome);

}  // namespace kinemark::pipeline
