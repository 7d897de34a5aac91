// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page that a job writes besides its results.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// A page that is begun before a long computation, so that a place where it cannot be written is told at
/// once, and appears when the results are there.
class PageFile {
 public:
  /// @param path    of the page; empty: none is wanted, and write() does nothing
  /// @param others  files that the job reads or writes: the page may be none of them, nor of `job.kept`
  ///                (Code::usage)
  static Result<PageFile> begin(const std::filesystem::path& path, const JobSettings& job,
                                const std::vector<std::filesystem::path>& others);

  [[nodiscard]] bool wanted() const { return file_.has_value(); }  ///< whether a page was asked for
  /// Files that the job has read meanwhile, as Staging::add_inputs(): write() fails where the page is one.
  void add_inputs(const std::vector<data::InputFile>& inputs);
  /// Let the page appear, and add it to what the job has written.
  [[nodiscard]] Status write(std::string_view html, JobOutcome& outcome);

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> inputs_;  ///< that are known since begin()
  std::optional<io::OutputFile> file_;
};

}  // namespace kinemark::pipeline
