// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "studies/common/study_table.h"

namespace kinemark::studies {

/// A picture of a study's page, 640 pixels wide at most.
struct StudyFigure {
  std::string caption;  ///< plain text
  std::string body;     ///< HTML, such as SvgPlot::svg() and a paragraph
};

/// A study as one page. Words are plain text: `<` and `&` mean themselves.
struct StudyPage {
  std::string title;                 ///< of the window
  std::string heading, description;  ///< on top of the page
  std::string classic = "classic";   ///< name of that column
  std::vector<StudyFigure> figures;
  StudyTable table;
};

/// One self-contained page in the design of all pages: bounds that are missed, figures, table.
[[nodiscard]] std::string study_html(const StudyPage& page);

}  // namespace kinemark::studies
