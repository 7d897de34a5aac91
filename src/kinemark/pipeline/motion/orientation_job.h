// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint angles from the orientations of inertial sensors, from files to files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/motion/sensor_settings.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::pipeline {

/// What `kinemark ik --orientations` is asked to do. Writes Q.mot, Q_sd.sto, Q_orientation_errors.sto and
/// Q_report.json.
/// Without a pose, and without frames of the model, the first whole frame is one.
struct OrientationJob : JobSettings, SensorSettings {
  std::filesystem::path model;                  ///< .osim; it needs no markers
  std::filesystem::path output;                 ///< Q.mot
  std::filesystem::path report;                 ///< page to write as well; empty: none
  std::vector<std::filesystem::path> geometry;  ///< further folders of the model's meshes, for the page
};

/// What it did.
struct OrientationOutcome : JobOutcome {
  motion::OrientationResult result;     ///< motion and fit
  std::string model;                    ///< its name
  std::string command_line;             ///< as typed
  std::vector<data::InputFile> inputs;  ///< all that were read
};

/// Read, solve, judge and write. Either all files appear or, on a failure, none. Progress counts frames.
///
/// Code::usage without model, orientations or output; else as io::read_osim(), io::read_orientations() and
/// motion::solve_orientations().
[[nodiscard]] Result<OrientationOutcome> run_orientations(OrientationJob job);

/// Inputs, frames, coordinates with the share of frames that determine them, sensors, heading, noise, gates,
/// warnings. Angles in degrees.
[[nodiscard]] nlohmann::ordered_json orientation_json(const OrientationOutcome& outcome);

}  // namespace kinemark::pipeline
