// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A table of coordinates and the model that it is of, as the motion of the model's bodies.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/table.h"
#include "kinemark/io/animation/pose_tree.h"

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

}  // namespace kinemark::pipeline
