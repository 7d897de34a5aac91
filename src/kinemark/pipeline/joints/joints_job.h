// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres and axes of a recording of markers, from file to files.
#pragma once

#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/workflow/joints/joints.h"

namespace kinemark::pipeline {

/// What `kinemark joints` is asked to do. Paths that are empty are not used. Doubtful samples are dropped
/// unless they are to be kept.
struct JointsJob : JobSettings, RecordingOptions, workflow::JointsMethod {
  std::filesystem::path input;     ///< .c3d, .trc, .csv, .nwb or .v3d
  std::filesystem::path segments;  ///< TOML, see read_segments(), or the .vsk of a Vicon subject, see
                                   ///< layout_of(); empty: by the markers' names or from the data
  /// A folder (no ending, or there already): centres.csv, centres.c3d, segments.toml and skeleton.json. A
  /// file: the centres in its format, and NAME_skeleton.json beside it. Where no joint is determined, the
  /// JSON alone.
  std::filesystem::path output;
  std::filesystem::path report;   ///< page to write as well, .html
  std::filesystem::path figures;  ///< picture to write as well, .svg: limb_figure()
};

/// Warnings and gates are the remarks of workflow::joints(), which are empty here.
struct JointsOutcome : JobOutcome, workflow::JointsFound {
  data::InputFile input;  ///< the recording
};

/// Read, workflow::joints(), write. Either all files appear or, on a failure, none. Progress counts frames.
[[nodiscard]] Result<JointsOutcome> run_joints(const JointsJob& job);

}  // namespace kinemark::pipeline
