// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/desk_page.h"

#include "kinemark/core/version.h"
#include "kinemark/stages/report/desk_report.h"

namespace kinemark::pipeline {

std::string desk_page(const std::string& source, const std::filesystem::path& folder) {
  return report::desk_report_html(
      {.source = source, .version = std::string(kVersion), .folder = folder.string()});
}

}  // namespace kinemark::pipeline
