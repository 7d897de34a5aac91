// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_page.h"

#include <fmt/core.h>

#include <optional>

#include "kinemark/core/html_text.h"

namespace kinemark::studies {
namespace {

// Two figures side by side where the window has room for them, none wider than its picture; the table keeps
// its head in sight.
constexpr const char* kStyle =
    "<style>"
    "body{font:15px/1.45 system-ui,sans-serif;color:#1a1a1a;background:#fff;max-width:1320px;"
    "margin:2em auto;padding:0 1em}"
    "h1{font-size:1.7em;margin-bottom:.3em}.words{max-width:52em}"
    ".figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,640px),1fr));gap:1.5em 2em}"
    "figure{margin:0;max-width:640px;break-inside:avoid}figcaption{font-weight:600}figure "
    "p{margin:.2em 0;font-size:.93em}"
    "svg{font:12px system-ui,sans-serif;max-width:100%;height:auto}svg text{fill:#1a1a1a}"
    ".grid{stroke:#e3e3e3}.axis{stroke:#444;fill:none}.box{fill:none;stroke:#333;stroke-dasharray:5 4}"
    ".halo{paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}"
    "table{border-collapse:collapse;margin-top:2em}td,th{padding:2px 10px;text-align:right;"
    "border-bottom:1px solid #ddd;font-weight:normal}tr:first-child th{position:sticky;top:0;"
    "background:#fff;border-bottom:1px solid #444;font-weight:600}th:first-child{text-align:left}"
    ".fails{background:#f6d5d5}</style>";

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("<td>{:.4g}</td>", *value) : std::string("<td></td>");
}

std::string bound_cells(const StudyRow& row) {
  return row.has_bound() ? cell(row.at_least) + cell(row.at_most) : "<td colspan=\"2\">no bound</td>";
}

}  // namespace

std::string study_table_html(const StudyTable& table, std::string_view classic) {
  std::string out = fmt::format(
      "<table><tr><th></th><th>unit</th><th>paper</th><th>{}</th><th>ours</th><th>expected</th><th>at "
      "least</th><th>at most</th></tr>",
      html_text(classic));
  for (const auto& row : table.rows)
    out += fmt::format("<tr{}><th>{}</th><td>{}</td>", row.pass() ? "" : " class=\"fails\"",
                       html_text(row.quantity), html_text(unit_text(row))) +
           cell(row.paper) + cell(row.classic) + cell(row.ours) +
           fmt::format("<td>{}</td>", expected_text(row)) + bound_cells(row) + "</tr>";
  return out + "</table>";
}

std::string study_html(const StudyPage& page) {
  std::string out = fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>{}</head><body><h1>{}"
      "</h1><p class=\"words\">{}</p><div class=\"figures\">",
      html_text(page.title), kStyle, html_text(page.heading), html_text(page.description));
  for (const auto& figure : page.figures)
    out +=
        fmt::format("<figure><figcaption>{}</figcaption>{}</figure>", html_text(figure.caption), figure.body);
  return out + "</div>" + study_table_html(page.table, page.classic) +
         fmt::format("<p class=\"words\">{}; a row that fails is red. {}</p></body></html>\n",
                     html_text(column_text(page.table)), html_text(missed_text(page.table)));
}

}  // namespace kinemark::studies
