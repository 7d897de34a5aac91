// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/selection.h"

namespace kinemark::pipeline {

/// What `kinemark convert` is asked to do.
struct ConvertJob : JobSettings {
  std::filesystem::path in;                   ///< file to convert
  std::filesystem::path out;                  ///< its ending names the format
  std::vector<std::filesystem::path> merged;  ///< with `in`, where these are files of one recording
  std::optional<double> resample_hz;          ///< frame rate of a marker file to write; none: as it is
  double rate_hz = 0.0;                       ///< of marker files that tell none (.v3d, .amc); 0: not given
  std::filesystem::path skeleton;             ///< .asf of an .amc; empty: the one beside it
  Selection selection;                        ///< of a marker file
  std::filesystem::path edits;  ///< journal of a marker file's edits, applied before all else; "beside": the
                                ///< one beside it, if there is one; empty: none
  bool ndx_pose = false;        ///< an .nwb also holds the markers as a pose of ndx-pose
  std::string rotate;           ///< turns markers and force plates, "x -90"; empty: as they are
  std::filesystem::path
      model;  ///< .osim that a table is the motion of, to make a skeleton of it; empty: none
};

/// Warnings: what was odd about the input and what the new format cannot hold.
struct ConvertOutcome : JobOutcome {};

/// Read one file and write it in the format that `out` ends in; both must be of one kind (markers, tables or
/// models), else Code::usage; but a table becomes a .mat, and a
/// .bvh or .glb with the model that it is the motion of.
/// Fails as reader and writer of the formats.
[[nodiscard]] Result<ConvertOutcome> run_convert(const ConvertJob& job);

}  // namespace kinemark::pipeline
