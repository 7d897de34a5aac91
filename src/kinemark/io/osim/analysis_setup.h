// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// OpenSim's Kinematics analysis: coordinates, speeds, accelerations.
struct KinematicsAnalysis {
  std::string name = "Kinematics";       ///< of the analysis, for its files
  std::vector<std::string> coordinates;  ///< "all" may be among them
  bool in_degrees = true;                ///< rotations in the tables
};

/// OpenSim's BodyKinematics analysis.
struct BodyKinematicsAnalysis {
  std::string name = "BodyKinematics";  ///< of the analysis, for its files
  std::vector<std::string> bodies;      ///< "all" and "center_of_mass" may be among them
  bool in_degrees = true;               ///< rotations in the tables
  bool in_body = false;                 ///< velocities and accelerations in the body's own axes
};

/// OpenSim's PointKinematics analysis of one point.
struct PointKinematicsAnalysis {
  std::string name = "PointKinematics";                 ///< of the analysis, for its files
  std::string point;                                    ///< name of the point; may be empty
  std::string body, relative_to;                        ///< of the model, or "ground"
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
};

/// OpenSim's setup of what is computed along a motion: an AnalyzeTool or an InverseDynamicsTool file. Paths
/// are resolved against the folder of the setup file; one that the file leaves out (or calls "Unassigned") is
/// empty. A file to read that is not where the setup says is looked for beside the setup by its name.
struct AnalysisSetup {
  std::string name;                           ///< of the tool; may be empty
  std::filesystem::path model_file;           ///< empty: not said
  std::filesystem::path coordinates_file;     ///< the motion; empty: not said
  std::filesystem::path external_loads_file;  ///< ExternalLoads; empty: none
  std::filesystem::path results_directory;    ///< empty: not said
  std::string force_file;                     ///< name of the table of torques; empty: not said
  double time_begin_s = -std::numeric_limits<double>::infinity();  ///< infinite: from the first row
  double time_end_s = std::numeric_limits<double>::infinity();     ///< infinite: to the last row
  double cutoff_hz = 0.0;                        ///< low-pass of the coordinates beforehand; 0: none
  bool torques = false;                          ///< inverse dynamics is asked for
  std::optional<KinematicsAnalysis> kinematics;  ///< of coordinates
  std::optional<BodyKinematicsAnalysis> bodies;  ///< of bodies
  std::vector<PointKinematicsAnalysis> points;   ///< of points, one each
  /// Files found beside the setup, and analyses that are passed over, one sentence each.
  std::vector<std::string> notes;
};

/// Read an AnalyzeTool or InverseDynamicsTool file. Analyses that are switched off do not count. Of the
/// others, Kinematics, BodyKinematics, PointKinematics and InverseDynamics are taken, each kind but
/// PointKinematics once; the rest (of muscles, of joint reactions) are notes.
///
/// Errors are one sentence with file, element and what was found; Code::not_supported for an AnalyzeTool that
/// reads states instead of coordinates.
[[nodiscard]] Result<AnalysisSetup> read_analysis_setup(const std::filesystem::path& path);

}  // namespace kinemark::io
