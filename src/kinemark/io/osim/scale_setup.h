// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/ik_setup.h"

namespace kinemark::io {

/// Bodies that a measurement scales, and along which axes.
struct ScaledBody {
  std::string body;
  Eigen::Vector3d axes = Eigen::Vector3d::Ones();  ///< 1 where the body is scaled, else 0
};

struct ScaleMeasurement {
  struct Pair {
    std::string first, second;
  };
  std::string name;
  bool apply = true;
  std::vector<Pair> pairs;
  std::vector<ScaledBody> bodies;
};

struct ScaleByHand {
  std::string body;
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  bool apply = true;
};

/// OpenSim's setup of scaling. Paths are resolved against the folder of the setup file; one that the file
/// leaves out (or calls "Unassigned") is empty. Nothing but sets named by `file=` is opened.
struct ScaleSetup {
  enum class Step : std::uint8_t { measurements, manual_scale };

  std::string name;
  double mass_kg = 0.0;    ///< 0: not given (OpenSim writes -1)
  double height_mm = 0.0;  ///< 0: not given; for information only

  std::filesystem::path model_file, marker_set_file;  ///< GenericModelMaker

  bool scale = true;  ///< ModelScaler
  std::vector<Step> order;
  std::vector<ScaleMeasurement> measurements;
  std::vector<ScaleByHand> manual;
  std::filesystem::path scale_marker_file;
  double scale_begin_s = -std::numeric_limits<double>::infinity();
  double scale_end_s = std::numeric_limits<double>::infinity();
  bool preserve_mass_distribution = false;
  std::filesystem::path scaled_model_file, scale_set_file;

  bool place = true;  ///< MarkerPlacer
  IkTasks tasks;
  std::filesystem::path place_marker_file, coordinate_file;
  double place_begin_s = -std::numeric_limits<double>::infinity();
  double place_end_s = std::numeric_limits<double>::infinity();
  double max_marker_movement_mm = -1.0;  ///< below 0: any
  std::filesystem::path output_model_file, output_motion_file;
};

/// Read a ScaleTool file. A part that is missing is not applied. Both spellings of old and new files
/// (<segment> or the scale's name, <MarkerPlacer> with or without a name) are read. Errors are one sentence
/// with file, element and what was found.
[[nodiscard]] Result<ScaleSetup> read_scale_setup(const std::filesystem::path& path);

/// The factors of a ScaleSet file, as ScaleTool writes them.
[[nodiscard]] Result<std::vector<ScaleByHand>> read_scale_set(const std::filesystem::path& path);

/// A marker of a MarkerSet file.
struct MarkerOfSet {
  std::string name, body;
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
  bool fixed = false;
};

/// Read a MarkerSet file, with <body> or with <socket_parent_frame>.
[[nodiscard]] Result<std::vector<MarkerOfSet>> read_marker_set(const std::filesystem::path& path);

/// Put the markers of a set into a model: one of the same name is replaced, others are added. Fails for a
/// body that the model does not have.
[[nodiscard]] Status merge_markers(data::ModelDescription& model, const std::vector<MarkerOfSet>& markers);

}  // namespace kinemark::io
