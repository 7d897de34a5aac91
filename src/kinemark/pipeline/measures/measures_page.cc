// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

// Values that a reader must not take at their face.
std::vector<report::Notice> remarks(const std::vector<data::Measure>& measures, bool determined) {
  std::vector<report::Notice> out;
  for (const auto& measure : measures)
    if (!measure.remark.empty() && std::isfinite(measure.value) == determined)
      out.push_back(
          {.about = "measure",
           .subject = measure.subject,
           .text = fmt::format("{}{}: {}: {}.", measure.subject.empty() ? "Walking" : measure.subject,
                               measure.region.empty() ? "" : ", " + measure.region, title_of_measure(measure),
                               measure.remark)});
  return out;
}

// What the page is of, and what its rows are of.
struct Headings {
  const char* page;
  const char* rows;
};

Headings headings(workflow::MeasuresOf of) {
  switch (of) {
    case workflow::MeasuresOf::walking:
      return {.page = "Walking and force plates", .rows = "Walking or plate"};
    case workflow::MeasuresOf::muscles:
      return {.page = "Electromyograms", .rows = "Channel"};
    case workflow::MeasuresOf::paths:
      return {.page = "Paths of markers", .rows = "Marker"};
    case workflow::MeasuresOf::everything:
      break;
  }
  return {.page = "All measures of a recording", .rows = "Marker, plate or channel"};
}

}  // namespace

std::string measures_page(const MeasuresJob& job, const MeasuresOutcome& outcome,
                          const std::vector<NamedFigure>& figures) {
  report::ResultReport out{.kind = "measures",
                           .trial = job.input.filename().string(),
                           .version = std::string(kVersion),
                           .command_line = job.command_line,
                           .inputs = inputs_of(outcome)};
  report::add_remarks(out.groups, outcome.warnings);
  report::add_group(out.groups, report::Verdict::attention, "measure", "measure not determined",
                    "measures not determined", remarks(outcome.measures, false));
  report::add_group(out.groups, report::Verdict::good, "measure", "remark on a measure",
                    "remarks on measures", remarks(outcome.measures, true));
  std::set<std::string> markers, regions;
  double not_measured = 0.0;
  for (const auto& measure : outcome.measures) {
    if (!measure.subject.empty()) markers.insert(measure.subject);
    regions.insert(measure.region);
    not_measured = std::max(not_measured, measure.share_not_measured);
  }
  out.result["heading"] = headings(job.of).page;
  out.result["rows"] = headings(job.of).rows;
  out.result["markers"] = markers.size();
  out.result["regions"] = regions.size();
  out.result["level"] = job.level;
  out.result["refits"] = job.refits;
  out.result["most_not_measured"] = not_measured;
  out.result["measures"] = measures_json(outcome.measures);
  for (std::size_t i = 0; i < outcome.measures.size(); ++i) {
    auto& row = out.result["measures"][i];
    row["title"] = title_of_measure(outcome.measures[i]);
    if (outcome.measures[i].subject.empty()) row["subject"] = "Walking";
    row["shown"] = shown_value(outcome.measures[i]);
  }
  out.result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : figures) {
    auto drawn = figure.figure;
    const std::string caption = std::exchange(drawn.title, {});  // the page writes it above the drawing
    out.result["figures"].push_back(
        {{"name", figure.name}, {"caption", caption}, {"body", report::figure_svg(drawn)}});
  }
  return report::result_report_html(out);
}

}  // namespace kinemark::pipeline
