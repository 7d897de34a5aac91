// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_json.h"

#include <utility>
#include <vector>

#include "kinemark/core/version.h"
#include "kinemark/pipeline/foundations/foundation_json.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using report::Notice;
using report::Verdict;

std::vector<Notice> notices(const std::vector<std::string>& sentences) {
  std::vector<Notice> out;
  for (const auto& sentence : sentences) out.push_back({.text = sentence});
  return out;
}

std::vector<report::NoticeGroup> groups_of(const ScaleOutcome& outcome) {
  std::vector<report::NoticeGroup> groups;
  report::add_gates(groups, outcome.gates);
  for (const auto* adapted : {&outcome.from_static, &outcome.from_motion}) {
    if (!*adapted) continue;
    const auto& result = **adapted;
    if (!result.converged)
      report::add_group(groups, Verdict::attention, "fit", "fit that did not converge", "",
                        {{.text = "The fit of the sizes stopped at its largest number of steps."}});
    report::add_group(groups, Verdict::good, "size", "number that these data do not determine",
                      "numbers that these data do not determine", notices(result.not_determined));
    report::add_group(groups, Verdict::good, "size", "recommendation", "recommendations",
                      notices(result.recommendations));
  }
  report::add_group(groups, Verdict::good, "file", "part of the file that was not kept",
                    "parts of the file that were not kept", notices(outcome.lost));
  report::add_remarks(groups, outcome.warnings);
  return groups;
}

using nlohmann::ordered_json;

ordered_json numbers(const Eigen::Vector3d& v) { return ordered_json::array({v.x(), v.y(), v.z()}); }

const char* word(motion::ParameterKind kind) {
  if (kind == motion::ParameterKind::body_scale) return "size";
  return kind == motion::ParameterKind::joint_offset ? "joint place" : "marker place";
}

ordered_json measurements(const motion::ScaleResult& scaled) {
  ordered_json list = ordered_json::array();
  for (const auto& measurement : scaled.measurements) {
    ordered_json pairs = ordered_json::array();
    for (const auto& pair : measurement.pairs)
      pairs.push_back({{"markers", {pair.first, pair.second}},
                       {"measured_m", pair.measured_m},
                       {"measured_sd_m", pair.measured_sd_m},
                       {"model_m", pair.model_m}});
    list.push_back({{"name", measurement.name}, {"factor", measurement.factor}, {"pairs", std::move(pairs)}});
  }
  return list;
}

/// Lengths of muscles and ligaments in the default pose.
ordered_json muscles(const std::vector<data::PathScale>& scales) {
  ordered_json list = ordered_json::array();
  for (const auto& muscle : scales)
    list.push_back({{"name", muscle.name},
                    {"ratio", muscle.ratio},
                    {"before_m", muscle.before_m},
                    {"after_m", muscle.after_m},
                    {"straight_for_wrapped", muscle.wraps}});
  return list;
}

}  // namespace

ordered_json adapted_json(const motion::AdaptResult& result, bool moved) {
  ordered_json parameters = ordered_json::array(), lengths = ordered_json::array();
  for (const auto& p : result.parameters)
    parameters.push_back({{"name", p.name},
                          {"kind", word(p.kind)},
                          {"initial", p.initial},
                          {"value", p.value},
                          {"sd", p.interval()},
                          {"prior_sd", p.prior_sd},
                          {"determined", p.determined}});
  for (const auto& length : result.lengths)
    lengths.push_back({{"name", length.name},
                       {"initial_m", length.initial_m},
                       {"length_m", length.length_m},
                       {"sd_m", length.sd_m},
                       {"determined", length.determined}});
  return {{"frames", result.frames},
          {"iterations", result.iterations},
          {"converged", result.converged},
          {"rms_before_m", result.rms_before_m},
          {"rms_after_m", result.rms_after_m},
          {"noise_sd_m", result.noise_sd_m},
          {"soft_tissue_sd_m", moved ? ordered_json(result.tissue_sd_m) : ordered_json()},
          {"lengths", std::move(lengths)},
          {"parameters", std::move(parameters)},
          {"not_determined", result.not_determined},
          {"recommendations", result.recommendations}};
}

std::string scale_page(const ScaleJob& job, const ScaleOutcome& outcome) {
  return report::result_report_html({.kind = "scale",
                                     .trial = job.output.filename().string(),
                                     .version = std::string(kVersion),
                                     .command_line = job.command_line,
                                     .groups = groups_of(outcome),
                                     .result = scale_json(job, outcome)});
}

ordered_json scale_json(const ScaleJob& job, const ScaleOutcome& outcome) {
  ordered_json factors = ordered_json::object();
  double mass = 0.0;
  for (const auto& body : outcome.factors) factors[body.body] = numbers(body.factors);
  for (const auto& body : outcome.model.bodies) mass += body.mass;
  ordered_json report{{"format", "kinemark-scale"},
                      {"version", 1},
                      {"program", kVersion},
                      {"command", job.command_line},
                      {"model", outcome.model.name},
                      {"mass_kg", mass},
                      {"exit_status", outcome.exit_status()},
                      {"notes", outcome.warnings},
                      {"clavicles", outcome.clavicles},
                      {"factors", std::move(factors)}};
  report["joints"] = outcome.joints;
  report["muscles"] = muscles(outcome.muscles);
  report["lost"] = outcome.lost;
  if (!outcome.static_trials.empty()) {
    report["static_trials"] = ordered_json::array();
    for (const auto& trial : outcome.static_trials)
      report["static_trials"].push_back(foundation_json(trial.file, trial.judgement));
  }
  if (outcome.scaled) report["measurements"] = measurements(*outcome.scaled);
  if (outcome.placed) {
    ordered_json placed = ordered_json::array();
    for (const auto& marker : outcome.placed->markers)
      placed.push_back({{"name", marker.name},
                        {"body", marker.body},
                        {"before_in_body_m", numbers(marker.before_in_body)},
                        {"after_in_body_m", numbers(marker.after_in_body)},
                        {"error_m", marker.error_m},
                        {"fixed", marker.fixed}});
    report["placed"] = {{"rms_m", outcome.placed->rms_m},
                        {"not_in_static_trial", outcome.placed->unseen},
                        {"markers", std::move(placed)}};
  }
  if (outcome.from_static) report["static"] = adapted_json(*outcome.from_static, false);
  if (outcome.from_motion) report["motion"] = adapted_json(*outcome.from_motion, true);
  return report;
}

}  // namespace kinemark::pipeline
