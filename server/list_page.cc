// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/list_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "kinemark/core/html_text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/core/version.h"

namespace kinemark::server {
namespace {

std::string plural(std::size_t n, std::string_view one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

std::string cell(std::string_view text, bool is_number = true) {
  return fmt::format("<td{}>{}</td>", is_number ? " class=\"number\"" : "", html_text(text));
}

std::string count_cell(const std::optional<std::int64_t>& value) {
  return cell(value ? std::to_string(*value) : "");
}

std::string measured_text(const TrialRow& row) {
  if (!row.measured) return "";
  // Only all of them is 100 %.
  const double percent = 100.0 * *row.measured;
  return percent < 100.0 ? fmt::format("{:.1f} %", std::min(percent, 99.9)) : "100 %";
}

std::string verdict_text(const TrialRow& row) {
  if (row.state == RowState::reading) return "<span class=\"tag\">being read</span>";
  if (row.state == RowState::unreadable) return "<span class=\"tag attention\">not readable</span>";
  if (row.verdict == "good") return "<span class=\"tag good\">Good</span>";
  if (row.verdict == "attention") return "<span class=\"tag attention\">Needs attention</span>";
  return "";
}

std::string table_row(const TrialRow& row, bool shows_folder, std::string_view root) {
  std::string text = fmt::format("<tr><th scope=\"row\"><a href=\"{}trial/{}\">{}</a>", root, row.number,
                                 html_text(row.name.empty() ? "(no name)" : row.name));
  if (shows_folder) text += fmt::format("<small>{}</small>", html_text(row.folder));
  text += fmt::format("</th><td>{}</td>", verdict_text(row)) + cell(row.kind, false) +
          count_cell(row.markers) + count_cell(row.frames);
  text += cell(row.rate_hz ? fmt::format("{:.5g}", *row.rate_hz) : "");
  text += cell(row.duration_s ? fmt::format("{:.2f}", *row.duration_s) : "");
  text += cell(measured_text(row));
  text += fmt::format("<td class=\"said\">{}</td></tr>\n", html_text(row.said));
  return text;
}

std::string summary_of(const std::vector<TrialRow>& rows) {
  const auto in_state = [&](RowState state) {
    return static_cast<std::size_t>(std::ranges::count(rows, state, &TrialRow::state));
  };
  const auto attention = static_cast<std::size_t>(std::ranges::count(rows, "attention", &TrialRow::verdict));
  std::string text = plural(rows.size(), "trial");
  if (attention > 0) text += fmt::format(", {} in need of attention", attention);
  if (const auto n = in_state(RowState::unreadable); n > 0) text += fmt::format(", {} not readable", n);
  if (const auto n = in_state(RowState::reading); n > 0)
    text += fmt::format(", {} being read: this page fills in by itself", n);
  return text;
}

constexpr std::string_view kHeads =
    "<thead><tr><th scope=\"col\">Trial</th><th scope=\"col\">Verdict</th><th scope=\"col\">Kind</th><th "
    "scope=\"col\" class=\"number\">"
    "Markers</th><th scope=\"col\" class=\"number\">Frames</th><th scope=\"col\" class=\"number\">Rate, Hz"
    "</th><th scope=\"col\" class=\"number\">Duration, s</th><th scope=\"col\" class=\"number\">Measured</th>"
    "<th scope=\"col\">Findings</th></tr></thead>\n";

}  // namespace

std::string page_head(std::string_view title, bool is_list, std::string_view root) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{0} - kinemark</title>\n"
      "<link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"{1}style.css\">\n"
      "<link rel=\"stylesheet\" href=\"{1}list.css\">\n{2}</head>\n<body>\n<div id=\"page\">\n",
      html_text(title), root,
      is_list ? fmt::format("<script type=\"module\" src=\"{}list.js\"></script>\n", root) : "");
}

std::string page_foot() {
  return fmt::format("<footer>kinemark {}</footer>\n</div>\n</body>\n</html>\n", kVersion);
}

std::string error_page(std::string_view title, std::string_view sentence, std::string_view root) {
  return page_head(title, false, root) +
         fmt::format(
             "<header><p class=\"brand\"><b>kinemark</b></p><h1>{}</h1><p class=\"model\">"
             "<a href=\"{}\">All trials</a></p></header>\n<main><p class=\"broken\">{}</p></main>\n",
             html_text(title), root, html_text(printable_sentence(sentence))) +
         page_foot();
}

std::string list_page(const std::vector<TrialRow>& rows, const std::vector<std::string>& notes,
                      std::string_view root) {
  std::set<std::string_view> folders;
  for (const auto& row : rows) folders.insert(row.folder);
  const bool reads = std::ranges::find(rows, RowState::reading, &TrialRow::state) != rows.end();
  std::string text = page_head("Trials", true, root);
  text += "<header><p class=\"brand\"><b>kinemark</b> trials</p><h1>Trials</h1>";
  if (folders.size() == 1 && !folders.begin()->empty())
    text += fmt::format("<p class=\"model\">{}</p>", html_text(*folders.begin()));
  text +=
      fmt::format("</header>\n<main id=\"trials\"{}>\n<section>\n<p class=\"lead\" role=\"status\">{}</p>\n",
                  reads ? " data-reading" : "", summary_of(rows));
  for (const auto& note : notes)
    text += fmt::format("<p class=\"broken\">{}</p>\n", html_text(printable_sentence(note)));
  if (!rows.empty()) {
    text += "<div class=\"table\" role=\"region\" aria-label=\"Trials\" tabindex=\"0\">\n<table>\n";
    text += kHeads;
    text += "<tbody>\n";
    for (const auto& row : rows) text += table_row(row, folders.size() > 1, root);
    text += "</tbody>\n</table>\n</div>\n";
  }
  return text + "</section>\n</main>\n" + page_foot();
}

}  // namespace kinemark::server
