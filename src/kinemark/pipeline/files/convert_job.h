// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"

namespace kinemark::pipeline {

/// What `kinemark convert` is asked to do. The options of a recording are for marker files alone; doubtful
/// samples are kept unless they are to be dropped.
struct ConvertJob : JobSettings, RecordingOptions {
  std::filesystem::path in;                   ///< file to convert
  std::filesystem::path out;                  ///< its ending names the format
  std::vector<std::filesystem::path> merged;  ///< with `in`, where these are files of one recording
  std::optional<double> resample_hz;          ///< frame rate of a marker file to write; none: as it is
  std::filesystem::path skeleton;             ///< .asf of an .amc; empty: the one beside it
  bool orientations = false;                  ///< write the orientations that the file holds, as .sto or .csv
  bool ndx_pose = false;                      ///< an .nwb also holds the markers as a pose of ndx-pose
  std::filesystem::path
      model;  ///< .osim that a table is the motion of, to make a skeleton of it; empty: none
};

/// Warnings: what was odd about the input and what the new format cannot hold.
struct ConvertOutcome : JobOutcome {};

/// Read one file and write it in the format that `out` ends in; both must be of one kind (markers, tables or
/// models), else Code::usage; but a table becomes a .mat, and a .bvh or .glb with the model that it is the
/// motion of, and a recording a .mot or .sto of the forces of its plates (io::table_of_forces(); below 20 N a
/// plate is empty). Orientations of sensors, segments and rigid bodies (io::read_orientation_file()) become
/// an .sto of OpenSense or a .csv where they are asked for, and where the input holds nothing else (.sto).
/// Fails as reader and writer of the formats.
[[nodiscard]] Result<ConvertOutcome> run_convert(const ConvertJob& job);

}  // namespace kinemark::pipeline
