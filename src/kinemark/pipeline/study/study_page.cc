// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study/study_page.h"

#include <fmt/core.h>

#include <optional>

#include "kinemark/io/file.h"

namespace kinemark::pipeline {
namespace {

constexpr const char* kStyle =
    "<style>"
    "body{font:14px sans-serif;max-width:1340px;margin:2em auto;padding:0 1em}svg{font:11px "
    "sans-serif}figure{display:inline-block;margin:0 1em 1em 0}"
    ".grid{stroke:#ddd}.box{fill:none;stroke:#333;stroke-dasharray:5 "
    "4}table{border-collapse:collapse}td,th{padding:2px 8px;text-align:right;"
    "border-bottom:1px solid "
    "#ddd;font-weight:normal}th:first-child{text-align:left}.fails{background:#f6d5d5}</style>";

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("<td>{:.4g}</td>", *value) : std::string("<td></td>");
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string study_table_html(const StudyTable& table, std::string_view classic) {
  std::string out = fmt::format(
      "<table><tr><th></th><th>unit</th><th>paper</th><th>{}</th><th>ours</th><th>limit</th><th>at "
      "least</th><th>at most</th></tr>",
      html_text(classic));
  for (const auto& row : table.rows)
    out += fmt::format("<tr{}><th>{}</th><td>{}</td>", row.pass() ? "" : " class=\"fails\"",
                       html_text(row.quantity), html_text(row.unit)) +
           cell(row.paper) + cell(row.classic) + cell(row.ours) + cell(row.limit) + cell(row.at_least) +
           cell(row.at_most) + "</tr>";
  return out + "</table>";
}

std::string study_html(const StudyPage& page) {
  std::string out = fmt::format(
      "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>{}</head><body><h1>{}"
      "</h1><p>{}</p>",
      html_text(page.title), kStyle, html_text(page.heading), html_text(page.words));
  for (const auto& figure : page.figures)
    out +=
        fmt::format("<figure><figcaption>{}</figcaption>{}</figure>", html_text(figure.caption), figure.body);
  return out + study_table_html(page.table, page.classic) + "</body></html>\n";
}

Status write_study_page(const StudyPage& page, const std::filesystem::path& path, bool force) {
  auto file = io::OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  if (auto s = file->write(study_html(page)); !s) return s;
  return file->commit();
}

}  // namespace kinemark::pipeline
