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
  std::string name;     ///< of the marker in the model
  double weight = 0.0;  ///< >= 0; OpenSim's default is 0
  bool apply = true;    ///< false: the marker takes no part
};

/// A coordinate task: a coordinate with a target value and a weight.
struct IkCoordinateTask {
  /// Where the value comes from.
  enum class Target : std::uint8_t {
    default_value,  ///< the coordinate's default in the model
    manual_value,   ///< `value`
    from_file,      ///< the column of that name in IkSetup::coordinate_file
  };
  std::string name;                       ///< of the coordinate in the model
  double weight = 0.0;                    ///< >= 0
  bool apply = true;                      ///< false: the task is switched off
  Target target = Target::default_value;  ///< where its value comes from
  double value = 0.0;                     ///< rad or m, for Target::manual_value
};

/// Weights of an IKTaskSet.
struct IkTasks {
  std::vector<IkMarkerTask> markers;          ///< in the order of the file
  std::vector<IkCoordinateTask> coordinates;  ///< in the order of the file
};

/// OpenSim's setup of one inverse-kinematics run. Paths are resolved against the folder of the setup file;
/// one that the file leaves out (or calls "Unassigned") is empty. A file to read that is not where the setup
/// says is looked for beside the setup by its name; else nothing is checked to exist.
struct IkSetup {
  std::string name;                          ///< of the tool; may be empty
  std::filesystem::path model_file;          ///< seen from the setup's folder; empty: not said
  std::filesystem::path marker_file;         ///< seen from the setup's folder; empty: not said
  std::filesystem::path coordinate_file;     ///< seen from the setup's folder; empty: none
  std::filesystem::path output_motion_file;  ///< seen from the setup's folder; empty: not said
  std::filesystem::path results_directory;   ///< seen from the setup's folder; empty: not said
  std::vector<std::filesystem::path> parts;  ///< files that elements were taken from: that of its tasks
  double time_begin_s = -std::numeric_limits<double>::infinity();      ///< infinite: from the first frame
  double time_end_s = std::numeric_limits<double>::infinity();         ///< infinite: to the last frame
  double constraint_weight = std::numeric_limits<double>::infinity();  ///< infinite: closed exactly
  double accuracy = 1e-5;                                              ///< OpenSim's stopping tolerance
  bool report_errors = true;             ///< OpenSim's switch for a table of errors
  bool report_marker_locations = false;  ///< OpenSim's switch for a table of marker positions
  IkTasks tasks;                         ///< weights of markers and coordinates
  std::vector<std::string> notes;        ///< files found beside the setup, one sentence each
};

/// Read an InverseKinematicsTool file, or an IKTool file of before 2.3 (its first trial), with the tasks
/// inside or in a file of their own. Errors are one sentence with file, element and what was found.
[[nodiscard]] Result<IkSetup> read_ik_setup(const std::filesystem::path& path);

/// Read a file that holds an IKTaskSet alone.
[[nodiscard]] Result<IkTasks> read_ik_tasks(const std::filesystem::path& path);

}  // namespace kinemark::io
