// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/gait/gait_tables.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

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

}  // namespace

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

}  // namespace kinemark::pipeline
