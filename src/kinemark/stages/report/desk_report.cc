// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/desk_report.h"

#include "kinemark/stages/report/internal/page.h"

namespace kinemark::report {

nlohmann::ordered_json desk_report_json(const DeskReport& report) {
  return {{"summary",
           {{"schema", "kinemark.desk"},
            {"schema_version", 1},
            {"trial", "Acquisition"},
            {"source", report.source},
            {"version", report.version},
            {"folder", report.folder}}}};
}

std::string desk_report_html(const DeskReport& report) {
  return internal::fill_page(desk_report_json(report));
}

}  // namespace kinemark::report
