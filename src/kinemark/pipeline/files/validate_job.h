// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/info_job.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What `kinemark validate` is asked to do.
struct ValidateJob : JobSettings {
  std::vector<std::filesystem::path> files;  ///< to look at
  std::filesystem::path model;  ///< .osim beside which tables of its coordinates are held; empty: none
  RecordingOptions recording;   ///< of those that are recordings; the rate: of those that tell none
};

/// One file that was looked at.
struct CheckedFile {
  std::filesystem::path file;         ///< as asked
  std::optional<FileFacts> facts;     ///< what it holds, when it can be read
  std::vector<std::string> warnings;  ///< what is odd about it
  std::vector<std::string>
      notes;  ///< what is good to know and not odd: that it was filtered, small faults of a model
  std::optional<Error> error;  ///< why it cannot be read

  /// 0 nothing to say, 1 readable with warnings, 3 or 4 not readable.
  [[nodiscard]] int exit_status() const;
};

/// What `kinemark validate` found.
struct ValidateOutcome : JobOutcome {
  std::vector<CheckedFile> files;  ///< in the order asked

  [[nodiscard]] int exit_status() const;  ///< the highest of all files
};

/// Read every file as run_info() does, and look for markers that carry each other's label. Succeeds whatever
/// the files are like, and fails where the model cannot be read or no file is a table; progress counts files,
/// and a caller that stops it ends with Code::cancelled.
[[nodiscard]] Result<ValidateOutcome> run_validate(const ValidateJob& job);

}  // namespace kinemark::pipeline
