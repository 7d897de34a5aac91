// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_page.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::studies {
namespace {

/// Bounds that are missed, one sentence each.
std::vector<report::Notice> missed(const StudyTable& table) {
  std::vector<report::Notice> out;
  for (const auto& row : table.rows) {
    if (row.pass()) continue;
    std::string asked;
    if (row.at_least) asked += fmt::format("at least {:.4g}", *row.at_least);
    if (row.at_most) asked += fmt::format("{}at most {:.4g}", asked.empty() ? "" : " and ", *row.at_most);
    out.push_back({.subject = row.quantity,
                   .text = fmt::format("{}: {:.4g}{}{}, asked is {}.", row.quantity, row.ours,
                                       unit_text(row).empty() ? "" : " ", unit_text(row), asked)});
  }
  return out;
}

}  // namespace

std::string study_html(const StudyPage& page) {
  report::ResultReport out{.kind = "study", .trial = page.heading, .version = std::string(kVersion)};
  report::add_group(out.groups, report::Verdict::attention, "gate", "bound missed", "bounds missed",
                    missed(page.table));
  out.result = study_json(page.table);
  out.result["title"] = page.title;
  out.result["description"] = page.description;
  out.result["classic"] = page.classic;
  out.result["columns"] = column_text(page.table);
  out.result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : page.figures)
    out.result["figures"].push_back({{"caption", figure.caption}, {"body", figure.body}});
  return report::result_report_html(out);
}

}  // namespace kinemark::studies
