// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/foundations/foundation_json.h"

#include <utility>

namespace kinemark::pipeline {

nlohmann::ordered_json foundation_json(const std::string& file,
                                       const motion::FoundationJudgement& judgement) {
  constexpr const char* kWhere[] = {"still", "movement", "either"};
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
    one["where"] = kWhere[static_cast<std::size_t>(finding.where)];
    one["score"] = finding.score;
    one["rivals"] = finding.rivals;
    one["sentence"] = motion::describe(finding, file);
    findings.push_back(std::move(one));
  }
  return {{"file", file},
          {"judged", judgement.judged},
          {"movements", judgement.movements},
          {"seen_at_50_mm", judgement.seen_at_50_mm},
          {"mirrored", judgement.mirrored},
          {"findings", std::move(findings)}};
}

}  // namespace kinemark::pipeline
