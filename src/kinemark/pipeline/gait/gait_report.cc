// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_report.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/pipeline/gait/gait_tables.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

/// The nine, the pelvis first.
struct Scored {
  std::string_view key, title;
};
constexpr std::array kScored = {
    Scored{"pelvis_tilt", "Pelvic tilt"},          Scored{"pelvis_obliquity", "Pelvic obliquity"},
    Scored{"pelvis_rotation", "Pelvic rotation"},  Scored{"hip_flexion", "Hip flexion"},
    Scored{"hip_adduction", "Hip adduction"},      Scored{"hip_rotation", "Hip rotation"},
    Scored{"knee_flexion", "Knee flexion"},        Scored{"ankle_dorsiflexion", "Ankle dorsiflexion"},
    Scored{"foot_progression", "Foot progression"}};
constexpr std::size_t kOfPelvis = 3;

// NaN as soon as one point has no value or no norm.
double score_of(const SheetCurve& curve) {
  if (curve.norm.rows() != curve.mean.size()) return kNaN;
  return std::sqrt((curve.mean - curve.norm.col(2)).squaredNorm() / static_cast<double>(curve.mean.size()));
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

using Json = nlohmann::ordered_json;

Json known(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json feet_json(const GaitSheet& sheet) {
  auto out = Json::array();
  for (const auto side : data::kBothSides) {
    const auto& foot = sheet.feet[data::index_of(side)];
    out.push_back({{"cycles", foot.cycles}, {"in_words", sentence_of(foot, side)}});
  }
  return out;
}

// Of kinetics alone no angle is drawn.
Json angles_json(const GaitSheet& sheet, const GaitPageFacts& facts) {
  const bool angles = std::ranges::any_of(
      sheet.panels, [](const SheetPanel& panel) { return panel.what.part != SheetPart::kinetics; });
  return angles ? Json(facts.angles_from) : Json(nullptr);
}

Json level_json(const GaitSheet& sheet) {
  Json out = nullptr;
  for (const auto& measure : sheet.measures)
    if (measure.interval.kind != data::IntervalKind::none) out = measure.interval.level;
  return out;
}

Json sources_json(const GaitSheet& sheet) {
  auto out = Json::array();
  for (const auto& norm : sheet.norms)
    if (std::ranges::find(out, Json(norm.source)) == out.end()) out.push_back(norm.source);
  return out;
}

bool shows_own_error(const GaitSheet& sheet) {
  for (const auto& panel : sheet.panels)
    for (const auto& side : panel.sides)
      if (side && side->own.array().isFinite().any()) return true;
  return false;
}

Json figures_json(std::span<const GaitFigure> figures) {
  auto out = Json::array();
  for (const auto& figure : figures) {
    auto drawn = figure.figure;
    const std::string caption = std::exchange(drawn.title, {});  // the page writes it above the drawing
    out.push_back({{"name", figure.name}, {"caption", caption}, {"body", report::figure_svg(drawn)}});
  }
  return out;
}

Json measures_json(const GaitSheet& sheet) {
  auto out = Json::array();
  for (const auto& row : measure_rows(sheet))
    out.push_back({{"title", row.title},
                   {"region", row.region},
                   {"unit", row.unit},
                   {"value", row.value},
                   {"judgement", row.judgement},
                   {"norm", row.norm}});
  return out;
}

Json deviation_json(const GaitDeviation& deviation) {
  const auto sides = [](const std::array<double, 2>& deg) { return Json{known(deg[0]), known(deg[1])}; };
  auto scores = Json::array();
  for (const auto& score : deviation.scores)
    scores.push_back({{"title", score.title}, {"value_deg", sides(score.value_deg)}});
  return {{"scores", scores},
          {"side_deg", sides(deviation.side_deg)},
          {"both_deg", known(deviation.both_deg)},
          {"lacking", deviation.lacking}};
}

Json events_json(const GaitSheet& sheet) {
  auto out = Json::array();
  for (const auto& event : sheet.events)
    out.push_back({{"foot", data::to_string(event.side)},
                   {"event", data::to_string(event.what)},
                   {"time_s", event.time_s},
                   {"sd_s", known(event.sd_s)},
                   {"by", event.method}});
  return out;
}

constexpr const char* kCurvesFile = "gait_curves.csv";
constexpr const char* kPairsFile = "gait_pairs.csv";

}  // namespace

GaitDeviation gait_deviation(const GaitSheet& sheet) {
  GaitDeviation out;
  std::array<std::vector<double>, 2> all;
  bool any = false;
  for (const auto& [key, title] : kScored) {
    GaitVariableScore score{.title = std::string(title)};
    const auto panel = std::ranges::find_if(sheet.panels, [&](const SheetPanel& one) {
      return one.what.key == key && one.unit == "deg" && one.what.part == SheetPart::kinematics;
    });
    for (const auto side : data::kBothSides) {
      const auto i = data::index_of(side);
      if (panel != sheet.panels.end() && panel->sides[i]) score.value_deg[i] = score_of(*panel->sides[i]);
      all[i].push_back(score.value_deg[i]);
      any = any || std::isfinite(score.value_deg[i]);
    }
    if (!std::isfinite(score.value_deg[0]) || !std::isfinite(score.value_deg[1]))
      out.lacking.emplace_back(title);
    out.scores.push_back(std::move(score));
  }
  if (!any) return {};
  for (const auto side : data::kBothSides)
    out.side_deg[data::index_of(side)] = root_mean_square(all[data::index_of(side)]);
  auto both = all[data::index_of(Side::left)];
  const auto& right = all[data::index_of(Side::right)];
  both.insert(both.end(), right.begin() + kOfPelvis, right.end());
  out.both_deg = root_mean_square(both);
  return out;
}

std::string gait_page(const GaitSheet& sheet, const GaitDeviation& deviation,
                      std::span<const GaitFigure> figures, const GaitPageFacts& facts) {
  auto remarks = sheet.remarks;
  for (const auto& warning : facts.warnings)
    if (std::ranges::find(remarks, warning) == remarks.end()) remarks.push_back(warning);
  report::ResultReport out{.kind = "gait",
                           .trial = sheet.trial,
                           .version = std::string(kVersion),
                           .command_line = facts.command_line,
                           .inputs = facts.inputs};
  report::add_gates(out.groups, facts.gates);
  report::add_remarks(out.groups, remarks);
  out.result = {{"feet", feet_json(sheet)},
                {"angles_from", angles_json(sheet, facts)},
                {"treadmill", sheet.treadmill},
                {"level", level_json(sheet)},
                {"norm_sources", sources_json(sheet)},
                {"curve_norm", norms_in_words(sheet)},
                {"own_error", shows_own_error(sheet)},
                {"figures", figures_json(figures)},
                {"measures", measures_json(sheet)},
                {"deviation", deviation_json(deviation)},
                {"events", events_json(sheet)}};
  return report::result_report_html(out);
}

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
