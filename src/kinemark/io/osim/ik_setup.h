// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// The weight of one marker.
struct IkMarkerTask {
  std::string name;
  double weight = 0.0;  ///< >= 0; OpenSim's default is 0
  bool apply = true;
};

/// A coordinate task: a coordinate with a target value and a weight.
struct IkCoordinateTask {
  enum class Target : std::uint8_t {
    default_value,  ///< the coordinate's default in the model
    manual_value,   ///< `value`
    from_file,      ///< the column of that name in IkSetup::coordinate_file
  };
  std::string name;
  double weight = 0.0;  ///< >= 0
  bool apply = true;
  Target target = Target::default_value;
  double value = 0.0;  ///< rad or m, for Target::manual_value
};

struct IkTasks {
  std::vector<IkMarkerTask> markers;
  std::vector<IkCoordinateTask> coordinates;
};

/// OpenSim's setup of one inverse-kinematics run. Paths are resolved against the folder of the setup file;
/// one that the file leaves out (or calls "Unassigned") is empty. Nothing is opened or checked to exist.
struct IkSetup {
  std::string name;
  std::filesystem::path model_file;
  std::filesystem::path marker_file;
  std::filesystem::path coordinate_file;
  std::filesystem::path output_motion_file;
  std::filesystem::path results_directory;
  double time_begin_s = -std::numeric_limits<double>::infinity();
  double time_end_s = std::numeric_limits<double>::infinity();
  double constraint_weight = std::numeric_limits<double>::infinity();  ///< infinite: closed exactly
  double accuracy = 1e-5;
  bool report_errors = true;
  bool report_marker_locations = false;
  IkTasks tasks;
};

/// Read an InverseKinematicsTool file, or an IKTool file of before 2.3 (its first trial), with the tasks
/// inside or in a file of their own. Errors are one sentence with file, element and what was found.
[[nodiscard]] Result<IkSetup> read_ik_setup(const std::filesystem::path& path);

/// Read a file that holds an IKTaskSet alone.
[[nodiscard]] Result<IkTasks> read_ik_tasks(const std::filesystem::path& path);

}  // namespace kinemark::io
