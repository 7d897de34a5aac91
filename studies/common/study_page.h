// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
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

/// The table alone, an HTML element: rows that fail have the class "fails".
[[nodiscard]] std::string study_table_html(const StudyTable& table, std::string_view classic);

/// One self-contained page: heading, figures, table. Nothing is fetched.
[[nodiscard]] std::string study_html(const StudyPage& page);

}  // namespace kinemark::studies
