// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/scale_recipe.h"
#include "kinemark/io/osim/ik_setup.h"

namespace kinemark::io {

/// OpenSim's setup of scaling. Paths are resolved against the folder of the setup file; one that the file
/// leaves out (or calls "Unassigned") is empty. A file to read that is not where the setup says is looked for
/// beside the setup by its name. Nothing but sets named by `file=` is opened.
struct ScaleSetup {
  std::string name;        ///< of the subject; may be empty
  double height_mm = 0.0;  ///< 0: not given; for information only

  std::filesystem::path model_file, marker_set_file;  ///< GenericModelMaker

  bool scale = true;  ///< ModelScaler
  /// What applies of it: without measurements and factors that are switched off or name no body; without any
  /// where the ModelScaler itself is. Its mass is the subject's (OpenSim writes -1 where it is not known).
  data::ScaleRecipe recipe;
  std::filesystem::path scale_marker_file;                  ///< recording to measure on; empty: none
  std::filesystem::path scaled_model_file, scale_set_file;  ///< where results go; empty: not said

  bool place = true;  ///< MarkerPlacer
  IkTasks tasks;      ///< weights of markers and coordinates when placing
  std::filesystem::path place_marker_file, coordinate_file;         ///< recording to place on; empty: none
  double place_begin_s = -std::numeric_limits<double>::infinity();  ///< infinite: from the first frame
  double place_end_s = std::numeric_limits<double>::infinity();     ///< infinite: to the last frame
  double max_marker_movement_mm = -1.0;                             ///< below 0: any
  std::filesystem::path output_model_file, output_motion_file;      ///< where results go; empty: not said

  std::vector<std::string> notes;            ///< files found beside the setup, one sentence each
  std::vector<std::filesystem::path> parts;  ///< files that elements were taken from: measurements, tasks
};

/// Read a ScaleTool file. A part that is missing is not applied. Both spellings of old and new files
/// (`segment` or the scale's name, `MarkerPlacer` with or without a name) are read. Errors are one sentence
/// with file, element and what was found.
[[nodiscard]] Result<ScaleSetup> read_scale_setup(const std::filesystem::path& path);

/// The factors of a ScaleSet file, as ScaleTool writes them; those that apply.
[[nodiscard]] Result<std::vector<data::BodyFactors>> read_scale_set(const std::filesystem::path& path);

/// A marker of a MarkerSet file.
struct MarkerOfSet {
  std::string name, body;                               ///< name in the model, "ground" among them
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
  bool fixed = false;  ///< the file's own switch: not to be moved when placing
};

/// Read a MarkerSet file, with `body` or with `socket_parent_frame`.
[[nodiscard]] Result<std::vector<MarkerOfSet>> read_marker_set(const std::filesystem::path& path);

/// Put the markers of a set into a model: one of the same name is replaced, others are added. Fails for a
/// body that the model does not have.
[[nodiscard]] Status merge_markers(data::ModelDescription& model, const std::vector<MarkerOfSet>& markers);

}  // namespace kinemark::io
