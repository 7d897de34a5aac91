// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/motion/markers_page.h"

namespace kinemark::pipeline {

/// What `kinemark report` is asked to do. The options of a recording are for marker files alone; doubtful
/// samples are kept unless they are to be dropped.
struct ReportJob : JobSettings, RecordingOptions {
  std::filesystem::path input;  ///< Q.mot (or Q_report.json) as `kinemark ik` wrote it, the rest lies beside
                                ///< it; or a marker file
  std::filesystem::path page;   ///< to write, .html
  std::filesystem::path skeleton = {};          ///< as MarkersPageOptions::skeleton
  std::vector<std::filesystem::path> geometry;  ///< further folders of the model's meshes
};

/// What `kinemark report` did.
struct ReportOutcome : JobOutcome {};

/// Make the page of a solved trial from its files, or of a marker file as it is. The gap map of a solved
/// trial shows the states of the recording when the file named in Q_report.json is still there. Code::io for
/// a file that is missing or a page that exists, Code::bad_input for files that do not fit.
[[nodiscard]] Result<ReportOutcome> run_report(const ReportJob& job);

/// HTML of any file that run_report() takes; nothing is written. Fails likewise.
[[nodiscard]] Result<std::string> page_of(const std::filesystem::path& path,
                                          const MarkersPageOptions& options = {});

}  // namespace kinemark::pipeline
