// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The files of a motion, and which of its rows count.
#pragma once

#include <filesystem>
#include <limits>

#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What every job on a motion and its model is told. Paths that are empty are not used.
struct MotionFiles : JobSettings {
  std::filesystem::path motion;  ///< .mot or .sto of coordinates; Q_sd.sto beside it is read if it is there
  std::filesystem::path model;   ///< .osim
  std::filesystem::path forces;  ///< external forces on the body, .c3d with plates or ExternalLoads .xml
  std::filesystem::path output;  ///< folder, or the file of a table
  bool torques = false;          ///< inverse dynamics too; `forces` implies it
  double cutoff_hz = 0.0;        ///< low-pass of the coordinates beforehand; 0: none, or as a setup says
  double first_time_s =
      -std::numeric_limits<double>::infinity();  ///< infinite: from the first row, or as a setup says
  double last_time_s = std::numeric_limits<double>::infinity();  ///< included; infinite likewise
};

}  // namespace kinemark::pipeline
