// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_report.h"

#include <fmt/core.h>

#include <iterator>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/gait/gait_tables.h"

namespace kinemark::pipeline {
namespace {

constexpr const char* kCurvesFile = "gait_curves.csv";
constexpr const char* kPairsFile = "gait_pairs.csv";

}  // namespace

Status GaitReportRequest::check() const {
  for (const auto& text : angle_angle) {
    const auto colon = text.find(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == text.size())
      return fail(Code::usage,
                  fmt::format("--angle-angle '{}' is not A:B, such as hip_flexion:knee_flexion", text));
  }
  return {};
}

std::unique_ptr<GaitReport> make_gait_report(const std::string& trial, const std::vector<SheetInput>& curves,
                                             const analysis::Gait& gait, const GaitNorms& norms,
                                             const std::vector<std::string>& angle_angle) {
  auto out = std::make_unique<GaitReport>();
  out->sheet = make_gait_sheet(trial, curves, gait, norms);
  out->deviation = gait_deviation(out->sheet);
  out->pairs = angle_pairs(out->sheet, angle_angle, out->sheet.remarks);
  out->figures = gait_figures(out->sheet);
  std::ranges::move(angle_angle_figures(out->sheet, out->pairs), std::back_inserter(out->figures));
  return out;
}

std::vector<std::string> gait_report_files(const GaitReport& report,
                                           const std::vector<std::string>& formats) {
  std::vector<std::string> out;
  for (const auto& figure : report.figures)
    for (const auto& format : formats) out.push_back(figure.name + "." + format);
  out.emplace_back(kCurvesFile);
  if (!report.pairs.empty()) out.emplace_back(kPairsFile);
  return out;
}

std::vector<ResultFile> gait_report_results(const GaitReport& report, const std::filesystem::path& folder,
                                            const std::vector<std::string>& formats) {
  std::vector<ResultFile> out;
  for (const auto& figure : report.figures)
    for (const auto& format : formats)
      out.push_back(
          {.target = folder / (figure.name + "." + format),
           .write = [&figure, format](const std::filesystem::path& staged, const std::string&) -> Status {
             const auto content = format == "png" ? report::figure_png(figure.figure)
                                                  : Result<std::string>(report::figure_svg(figure.figure));
             if (!content) return std::unexpected(content.error());
             return io::write_text(staged, *content, false);
           }});
  out.push_back(text_file(folder / kCurvesFile, [&report] { return sheet_csv(report.sheet); }));
  if (!report.pairs.empty())
    out.push_back(text_file(folder / kPairsFile, [&report] { return pairs_csv(report.pairs); }));
  return out;
}

std::string gait_report_page(const GaitReport& report, const GaitPageFacts& facts) {
  return gait_page(report.sheet, report.deviation, report.figures, facts);
}

}  // namespace kinemark::pipeline
