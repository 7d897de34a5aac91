// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/staging.h"
#include "studies/common/study_figure.h"
#include "studies/common/study_table.h"

namespace kinemark::studies {

/// A study as one page. Words are plain text: `<` and `&` mean themselves.
struct StudyPage {
  std::string title;                 ///< of the window
  std::string heading, description;  ///< on top of the page
  std::string classic = "classic";   ///< name of that column
  std::vector<StudyFigure> figures;
  StudyTable table;
};

/// One self-contained page in the design of all pages: bounds that are missed, figures with the paper's
/// numbers and ours under each, table.
[[nodiscard]] std::string study_html(const StudyPage& page);

/// Where the figures of a study go: a page (.html), or a folder for the page, study.html, and every figure as
/// .svg, .csv and, where the program was built with Cairo, .png.
class StudyFiles {
 public:
  /// Asks for the place before the study is run. Fails as pipeline::Staging.
  static Result<StudyFiles> create(const std::filesystem::path& place, const pipeline::JobSettings& settings);
  /// Everything appears or, on a failure, nothing. Returns what was written.
  [[nodiscard]] Result<std::vector<std::filesystem::path>> write(const StudyPage& page);

 private:
  StudyFiles(pipeline::Staging staging, std::filesystem::path folder, pipeline::JobSettings settings);
  pipeline::Staging staging_;
  std::filesystem::path folder_;  // empty: the page alone
  pipeline::JobSettings settings_;
};

}  // namespace kinemark::studies
