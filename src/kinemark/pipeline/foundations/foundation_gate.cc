// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/foundations/foundation_gate.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/workflow/foundations/foundation_gate.h"

namespace kinemark::pipeline {

Result<motion::FoundationJudgement> judge_static_trial(const std::string& file,
                                                       const motion::StandingBody& body,
                                                       const data::Trajectories& still,
                                                       std::span<const data::Trajectories* const> movements,
                                                       JobOutcome& outcome) {
  workflow::Remarks remarks;
  auto judgement = workflow::judge_static_trial(file, body, still, movements, remarks);
  std::ranges::move(remarks.warnings, std::back_inserter(outcome.warnings));
  std::ranges::move(remarks.gates, std::back_inserter(outcome.gates));
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
