// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What an analysis is to compute, after its setup was read and all names were found in the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/analysis_setup.h"
#include "kinemark/pipeline/motion/analysis_job.h"
#include "kinemark/stages/motion/dynamics/body_motion.h"

namespace kinemark::pipeline::internal {

/// Files, range and what is asked for; empty names: not asked for.
struct AnalysisPlan {
  std::filesystem::path motion, model, forces, output;
  std::string name;                              ///< that all files begin with
  double cutoff_hz = 0.0;                        ///< 0: none
  double first_time_s = 0.0, last_time_s = 0.0;  ///< infinite: all rows
  bool from_row_before = false;                  ///< the first row is at or before the first time
  std::string kinematics_name, bodies_name;      ///< of the analyses, for their files
  std::vector<int> coordinates;                  ///< of the model, for the first
  bool kinematics_in_degrees = true, bodies_in_degrees = true, mass_centre = false;
  motion::BodyMotionOptions follow;      ///< bodies and points
  std::vector<std::string> point_names;  ///< of the analyses of points, for their files
  std::string torque_file;               ///< name of the table of torques
  std::vector<std::string> notes;        ///< one sentence each
};

/// The job's own files, range and cut-off with those of its setup, which gives what the job leaves open.
struct AnalysisInputs {
  AnalysisPlan plan;                       ///< names of the model not yet in it
  std::optional<io::AnalysisSetup> setup;  ///< as read
};

/// Read the setup, if there is one. Code::usage for a motion, model or folder that neither names.
[[nodiscard]] Result<AnalysisInputs> read_analysis_inputs(const AnalysisJob& job);

/// Find what is asked for in the model. Code::usage for a body, point or coordinate that it does not have.
[[nodiscard]] Result<AnalysisPlan> plan_analysis(const AnalysisJob& job, AnalysisInputs inputs,
                                                 const data::ModelDescription& model);

}  // namespace kinemark::pipeline::internal
