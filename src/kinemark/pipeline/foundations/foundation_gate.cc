// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/foundations/foundation_gate.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/stages/motion/foundations/stillness.h"

namespace kinemark::pipeline {

Result<motion::FoundationJudgement> judge_static_trial(const std::string& file,
                                                       const motion::StandingBody& body,
                                                       const data::Trajectories& still,
                                                       std::span<const data::Trajectories* const> movements,
                                                       JobOutcome& outcome) {
  std::vector<std::string> names;
  for (const auto& marker : body.markers) names.push_back(marker.name);
  if (const auto unrest = motion::find_unrest(still, names))
    outcome.warnings.push_back(
        fmt::format("{}; a posture that is taken from all of it is a mean of different ones",
                    motion::describe(*unrest, file)));
  auto judgement = motion::judge_foundation(body, still, movements);
  if (!judgement) return fail_at(file, judgement.error());
  if (judgement->judged.empty()) return judgement;
  const auto found = judgement->findings.size();
  data::Gate gate{.name = "static_trial",
                  .passed = found == 0,
                  .value = static_cast<double>(found),
                  .bound = 0.0,
                  .unit = "findings",
                  .sentence = fmt::format("No marker of {} lies where a body cannot have it.", file)};
  if (found > 0) {
    std::vector<std::string> sentences;
    for (const auto& finding : judgement->findings) sentences.push_back(motion::describe(finding, file));
    gate.sentence = fmt::format(
        "The static trial cannot be built on: {}. Everything below takes it as it is; label it again or "
        "leave the "
        "marker out.",
        join(sentences, "; "));
    outcome.warnings.push_back(gate.sentence);
  }
  outcome.gates.push_back(std::move(gate));
  return judgement;
}

nlohmann::ordered_json foundation_json(const std::string& file,
                                       const motion::FoundationJudgement& judgement) {
  auto findings = nlohmann::ordered_json::array();
  for (const auto& finding : judgement.findings) {
    nlohmann::ordered_json one{{"marker", finding.marker}, {"partner", nullptr}};
    if (!finding.partner.empty()) {
      one["partner"] = finding.partner;
    } else {
      one["shift_m"] = {finding.shift_m.x(), finding.shift_m.y(), finding.shift_m.z()};
      one["shift_sd_m"] = {finding.shift_sd_m.x(), finding.shift_sd_m.y(), finding.shift_sd_m.z()};
    }
    one["by_movement"] = finding.by_movement;
    one["score"] = finding.score;
    one["rivals"] = finding.rivals;
    one["sentence"] = motion::describe(finding, file);
    findings.push_back(std::move(one));
  }
  return {{"file", file},
          {"judged", judgement.judged},
          {"movements", judgement.movements},
          {"findings", std::move(findings)}};
}

}  // namespace kinemark::pipeline
