// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What `kinemark report` is asked to do.
struct ReportJob : JobSettings {
  std::filesystem::path
      solved;  ///< Q.mot (or Q_report.json) as `kinemark ik` wrote it; the rest lies beside it
  std::filesystem::path page;  ///< to write, .html
};

struct ReportOutcome : JobOutcome {};

/// The page of a solved trial as HTML, as run_report() writes it.
/// @param solved  Q.mot or Q_report.json; the rest lies beside it
[[nodiscard]] Result<std::string> page_of(const std::filesystem::path& solved);

/// Make the page of a solved trial from its files. The gap map shows the states of the recording when the
/// file named in Q_report.json is still there. Code::io for a file that is missing or a page that exists,
/// Code::bad_input for files that do not fit.
[[nodiscard]] Result<ReportOutcome> run_report(const ReportJob& job);

}  // namespace kinemark::pipeline
