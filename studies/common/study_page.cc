// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_page.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/html_text.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/files/result_files.h"
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

// A drawing and what stands under it, as the page has it.
std::string body_of(const StudyFigure& figure, const std::string& classic) {
  std::string out = report::figure_svg(figure.figure);
  for (const auto& number : figure.numbers)
    out += fmt::format("<p>{}</p>", html_text(number_text(number, classic)));
  return out;
}

constexpr const char* kPage = "study.html";

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
    out.result["figures"].push_back({{"caption", figure.caption()}, {"body", body_of(figure, page.classic)}});
  return report::result_report_html(out);
}

StudyFiles::StudyFiles(pipeline::Staging staging, std::filesystem::path folder,
                       pipeline::JobSettings settings)
    : staging_(std::move(staging)), folder_(std::move(folder)), settings_(std::move(settings)) {}

Result<StudyFiles> StudyFiles::create(const std::filesystem::path& place,
                                      const pipeline::JobSettings& settings) {
  const bool folder = !place.has_extension() || std::filesystem::is_directory(place);
  auto staging = folder ? pipeline::Staging::create_in(place, {kPage}, settings, {})
                        : pipeline::Staging::create({place}, settings, {});
  if (!staging) return std::unexpected(staging.error());
  return StudyFiles(std::move(*staging), folder ? place : std::filesystem::path(), settings);
}

Result<std::vector<std::filesystem::path>> StudyFiles::write(const StudyPage& page) {
  const auto at = staging_.targets().front();
  std::vector<pipeline::ResultFile> files{pipeline::text_file(at, [&] { return study_html(page); })};
  if (folder_.empty()) return pipeline::write_results(staging_, files, {}, "the study");
  std::vector<std::string> names;
  for (const auto& figure : page.figures) {
    const auto print = figure_for_print(figure, page.classic);
    const auto add = [&](const char* ending, std::string text) {
      names.push_back(figure.file_name() + ending);
      files.push_back(pipeline::text_file(folder_ / names.back(), [text = std::move(text)] { return text; }));
    };
    add(".svg", report::figure_svg(print));
    add(".csv", figure_csv(figure));
    auto png = report::figure_png(print);
    if (png)
      add(".png", std::move(*png));
    else if (png.error().code != Code::not_supported)
      return std::unexpected(png.error());
  }
  if (auto s = staging_.add_in(folder_, names); !s) return std::unexpected(s.error());
  return pipeline::write_results(staging_, files, {}, "the study");
}

}  // namespace kinemark::studies
