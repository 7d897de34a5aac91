// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "kinemark/math/statistics.h"
#include "kinemark/pipeline/foundations/foundation_json.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/pipeline/segments/segments_job.h"
#include "kinemark/stages/report/inputs_json.h"
#include "kinemark/workflow/segments/subject_values.h"

namespace kinemark::pipeline {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// "agrees", "sentence", "outputs", "explained_by", "findings".
nlohmann::ordered_json comparison_json(const workflow::OutputComparison& comparison) {
  nlohmann::ordered_json out{{"agrees", comparison.agrees()},
                             {"sentence", comparison.summary()},
                             {"outputs", nlohmann::ordered_json::array()},
                             {"explained_by", nlohmann::ordered_json::array()},
                             {"findings", comparison.findings()}};
  for (const auto& o : comparison.outputs) {
    const double unit = o.angle ? kDegree : 1e-3;
    out["outputs"].push_back({{"name", o.name},
                              {"theirs", o.theirs},
                              {"unit", o.angle ? "deg" : "mm"},
                              {"median", o.median / unit},
                              {"p95", o.p95 / unit},
                              {"largest", o.largest / unit},
                              {"frames", o.frames}});
  }
  for (const auto& p : comparison.explanation.parameters)
    out["explained_by"].push_back({{"name", p.name},
                                   {"shown", p.value / workflow::per_shown(p.quantity)},
                                   {"used", p.used / workflow::per_shown(p.quantity)},
                                   {"unit", workflow::shown_unit(p.quantity)},
                                   {"from", p.from}});
  for (const auto& point : comparison.explanation.points)
    out["explained_by"].push_back({{"name", point}, {"regression", true}});
  return out;
}

}  // namespace

std::string assumed_measures(const analysis::SegmentMotion& motion) {
  std::vector<std::string> list;
  for (const auto& p : motion.parameters)
    if (p.assumed && p.sd > 0.0)
      list.push_back(fmt::format("{} {:.4g} {} (SD {:.2g}{})", p.name,
                                 p.value / workflow::per_shown(p.quantity), workflow::shown_unit(p.quantity),
                                 p.sd / workflow::per_shown(p.quantity),
                                 p.from.ends_with("outputs") ? "; by " + p.from : ""));
  return fmt::format("{}", fmt::join(list, ", "));
}

std::string sample_noise(const analysis::SegmentMotion& motion) {
  std::vector<double> mm;
  if (motion.noise)
    for (const auto& noise : motion.noise->all()) mm.push_back(1e3 * noise.sample_sd_m);
  if (mm.empty()) return {};
  const auto [least, most] = std::ranges::minmax(mm);
  return fmt::format("{:.2g} to {:.2g} mm a sample, median {:.2g}", least, most, math::median(mm));
}

nlohmann::ordered_json segments_outcome_json(const SegmentsOutcome& outcome) {
  nlohmann::ordered_json out;
  out["definition"] = outcome.title;
  out["inputs"] = report::inputs_json(outcome.inputs);
  out["parameters"] = parameters_json(outcome.motion);
  if (outcome.motion.noise) out["noise"] = noises_json(outcome.motion.noise->all());
  if (!outcome.comparison.empty()) out["comparison"] = comparison_json(outcome.comparison);
  out["angles"] = series_json(series_of(outcome.motion));
  out["loads"] = series_json(series_of(outcome.loads));
  out["steps"] = nlohmann::ordered_json::array();
  for (const auto& step : outcome.loads.steps)
    out["steps"].push_back(
        {{"body", step.body}, {"plate", step.plate}, {"begin_s", step.begin_s}, {"end_s", step.end_s}});
  out["cross_talk"] = nlohmann::ordered_json::array();
  for (const auto& [name, found] : outcome.cross_talk)
    out["cross_talk"].push_back({{"name", name},
                                 {"correlation", found.correlation},
                                 {"varus_deg", found.carried_rad / kDegree},
                                 {"flexion_deg", found.flexion_rad / kDegree},
                                 {"suspicious", found.suspicious()},
                                 {"sentence", found.sentence(name)}});
  if (outcome.static_trial) out["static_trial"] = foundation_json("the static trial", *outcome.static_trial);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
