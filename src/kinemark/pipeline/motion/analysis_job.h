// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What follows from a motion and its model: rates of the coordinates, where bodies and points are and how
// they move, torques. What OpenSim's AnalyzeTool and InverseDynamicsTool compute, each number with its
// deviation.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/table.h"
#include "kinemark/pipeline/motion/motion_files.h"
#include "kinemark/stages/motion/dynamics/body_motion.h"

namespace kinemark::pipeline {

// The tables of an analysis, with the labels that OpenSim's have.

/// Rows [first, last) of a motion.
struct RowRange {
  std::int64_t first = 0, last = 0;                                 ///< frames
  [[nodiscard]] std::int64_t size() const { return last - first; }  ///< number of rows
};

/// A value for each coordinate and frame, one column each.
/// @param values      F x n, in rad, m and their rates
/// @param columns     indices of coordinates
/// @param in_degrees  rotations in degrees instead of radians
[[nodiscard]] data::Table coordinate_rates_table(std::string name, const data::JointMotion& motion,
                                                 const Array<double>& values, const std::vector<int>& columns,
                                                 bool in_degrees, const RowRange& rows);

/// BodyKinematics: BODY_X, _Y, _Z, _Ox, _Oy, _Oz of each body, center_of_mass_X, _Y, _Z if asked for.
/// @param values  BodyMotion::value or sd @param order  0 position, 1 velocity, 2 acceleration
[[nodiscard]] data::Table bodies_table(const data::ModelDescription& model, const motion::BodyMotion& bodies,
                                       const Array<double>& values, const std::vector<int>& body_idx,
                                       bool mass_centre, int order, bool in_degrees, const RowRange& rows);

/// PointKinematics of one point: state_0, state_1, state_2 are x, y, z.
[[nodiscard]] data::Table point_table(const motion::BodyMotion& bodies, const Array<double>& values,
                                      std::int64_t point, int order, const RowRange& rows);

/// Some rows of a table.
[[nodiscard]] data::Table rows_of(data::Table table, const RowRange& rows);

/// A point of a body that is to be followed.
struct AnalysisPoint {
  std::string name, body;                               ///< body of the model, or "ground"
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
};

/// What `kinemark dynamics` is asked to do for tables.
struct AnalysisJob : MotionFiles {
  std::filesystem::path setup;        ///< AnalyzeTool or InverseDynamicsTool; empty: none
  std::vector<std::string> bodies;    ///< to follow; empty: as the setup says, else all
  std::vector<AnalysisPoint> points;  ///< to follow, besides those of the setup
  bool error_bars = true;             ///< standard deviations too
};

/// What it answers.
struct AnalysisOutcome : JobOutcome {
  TimeBase time;                                           ///< of the rows that were written
  std::vector<data::InputFile> inputs;                     ///< all that were read
  std::vector<std::pair<std::string, std::string>> facts;  ///< of method and torques, for the record
};

/// Compute and write, into the folder `output` under OpenSim's names, with NAME the setup's or the motion's:
/// NAME_Kinematics_{q,u,dudt}.sto, NAME_BodyKinematics_{pos,vel,acc}_global.sto,
/// NAME_PointKinematics_POINT_{pos,vel,acc}.sto, NAME_inverse_dynamics.sto, beside each its deviations
/// (..._sd.sto), and NAME_analysis.json. Rates come from the whole motion; rows are those from first to last
/// time, with a setup from the row at or before its first time, as OpenSim takes them.
///
/// A low-pass is OpenSim's (Butterworth of third order, run both ways, -3 dB of one pass at the cut-off).
/// What it leaves of the noise is not known, so that there are no deviations then.
///
/// Code::usage for what is not named or does not exist in the model; Code::bad_input for files that do not
/// fit; Code::io as Staging. Fails as inverse_dynamics() where torques are asked for.
[[nodiscard]] Result<AnalysisOutcome> run_analysis(const AnalysisJob& job);

}  // namespace kinemark::pipeline
