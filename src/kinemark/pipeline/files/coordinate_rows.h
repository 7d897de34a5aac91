// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A table of coordinates and the model that it is of, as the motion of the model's bodies.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/table.h"
#include "kinemark/io/animation/pose_tree.h"
#include "kinemark/model/model.h"

namespace kinemark::pipeline {

/// Bodies in motion, y up where the model has gravity.
struct ModelMotion {
  io::PoseTree poses;                     ///< a body each, at its origin
  bool y_is_up = true;                    ///< false: the model has no gravity, and its axes are as they were
  std::vector<std::string> notes;         ///< what was filled, taken or turned, one sentence each
  std::vector<std::string> contradicted;  ///< values that are no coordinates of a body, one sentence each
};

/// Poses of all bodies, row by row. A coordinate without a column keeps its default value; one that is
/// coupled to another follows it. Cells without a number are filled on a straight line between those around
/// them, and hold the nearest one at the ends. Turned so that y points up where the model's gravity points
/// another way down. A body that carries no other ends at its marker farthest from its origin, else at twice
/// its centre of mass.
///
/// Code::bad_input: fewer than two rows, rows that are not evenly spaced to a hundredth of a frame, no column
/// that is a coordinate, a coordinate without any number; else as model::Model::compile().
[[nodiscard]] Result<ModelMotion> move_model(data::ModelDescription description, const data::Table& table);

/// The same from files: an .osim, and a .mot or .sto.
[[nodiscard]] Result<ModelMotion> read_model_motion(const std::filesystem::path& model,
                                                    const std::filesystem::path& table);

/// Coordinates of a model through time, as a table has them: F frames, n coordinates.
struct CoordinateRows {
  TimeBase time;                   ///< F = time.frames
  std::vector<Eigen::VectorXd> q;  ///< F, each of n numbers in the model's order; rad and m, all finite
  Array<std::uint8_t> is_filled;   ///< F x n; 1: the table has no number there
  std::vector<bool> is_assumed;  ///< n; true: no column, it may move, and its default value is an assumption
  std::vector<std::string> notes;  ///< what was filled and taken, one sentence each
};

/// A coordinate without a column keeps its default value; one that is coupled to another is left to the
/// coupling, with a note where its column tells otherwise. Cells without a number are filled on a straight
/// line between those around them, and hold the nearest one at the ends. O(F n).
///
/// Code::bad_input: fewer than two rows, rows that are not evenly spaced to a hundredth of a frame (or to the
/// digits that their times have), no column that is a coordinate, a coordinate without any number, or beyond
/// a million.
[[nodiscard]] Result<CoordinateRows> coordinate_rows(const model::Model& model, const data::Table& table);

}  // namespace kinemark::pipeline
