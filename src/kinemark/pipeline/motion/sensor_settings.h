// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <numbers>
#include <string>

#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::pipeline {

/// Inertial sensors, as files and options say.
struct SensorSettings {
  std::filesystem::path orientations;  ///< .sto of quaternions, or .c3d with rotations; empty: no sensors
  std::filesystem::path pose;          ///< the same, in the model's default pose; empty: as others say
  std::string up;                      ///< axis of the sensors' world that points up, "z"; empty: the model's
  double max_rms_rad = 10.0 * std::numbers::pi / 180.0;  ///< gate: angle between measured and model, RMS
  motion::OrientationOptions options;                    ///< threads and seed are the job's
};

}  // namespace kinemark::pipeline
