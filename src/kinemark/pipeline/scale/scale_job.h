// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A model made to fit a subject, from files to files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/workflow/scale/scale.h"

namespace kinemark::pipeline {

/// What `kinemark scale` is asked to do. Paths that are empty are not used. The options of a recording count
/// for the motion and for static trials, but for frames and times, which are the motion's; names that a
/// static trial beside a motion does not have are passed over there.
struct ScaleJob : JobSettings, RecordingOptions, workflow::ScaleMethod {
  std::filesystem::path model;         ///< .osim to scale
  std::filesystem::path setup;         ///< OpenSim ScaleTool file; fills what the other fields leave open
  std::filesystem::path static_trial;  ///< marker file of a static trial
  std::filesystem::path markers;       ///< marker file of a motion: sizes and positions are adapted to it
  std::filesystem::path joints;        ///< skeleton.json of a motion, or its folder
  std::filesystem::path output;        ///< M.osim; M_report.json goes beside it
  std::filesystem::path report;        ///< page to write as well, .html
};

/// Warnings and gates are the remarks of workflow::scale(), which are empty here.
struct ScaleOutcome : JobOutcome, workflow::ScaleFound {
  std::vector<std::string> lost;  ///< what the file held and the output does not
};

/// Read, workflow::scale(), write: model, report and page, all or none of them. Joints of `joints` do not
/// count where they were found in the very recording that is adapted to, which shows them already. Progress
/// counts steps.
[[nodiscard]] Result<ScaleOutcome> run_scale(ScaleJob job);

}  // namespace kinemark::pipeline
