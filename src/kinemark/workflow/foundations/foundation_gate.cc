// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/foundations/foundation_gate.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/motion/foundations/landmarks.h"
#include "kinemark/stages/motion/foundations/stillness.h"

namespace kinemark::workflow {
namespace {

/// Whether a name is that of a landmark of pelvis or legs.
bool is_of_legs(const std::string& name) {
  const auto landmark = motion::landmark_of(name);
  return landmark &&
         (landmark->part == motion::BodyPart::pelvis || landmark->part == motion::BodyPart::thigh ||
          landmark->part == motion::BodyPart::shank || landmark->part == motion::BodyPart::foot);
}

std::vector<std::string> legs_of(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  std::ranges::copy_if(names, std::back_inserter(out), is_of_legs);
  return out;
}

}  // namespace

Result<motion::FoundationJudgement> judge_static_trial(const std::string& name,
                                                       const motion::StandingBody& body,
                                                       const data::Trajectories& still,
                                                       std::span<const data::Trajectories* const> movements,
                                                       Remarks& remarks) {
  std::vector<std::string> names;
  for (const auto& marker : body.markers) names.push_back(marker.name);
  if (const auto unrest = motion::find_unrest(still, names))
    remarks.warnings.push_back(
        fmt::format("{}; a posture that is taken from all of it is a mean of different ones",
                    motion::describe(*unrest, name)));
  auto judgement = motion::judge_foundation(body, still, movements);
  if (!judgement) return fail_at(name, judgement.error());
  if (judgement->judged.empty()) return judgement;
  const auto found = judgement->findings.size() + (judgement->mirrored ? 1 : 0);
  data::Gate gate{
      .name = "static_trial",
      .passed = found == 0,
      .value = static_cast<double>(found),
      .bound = 0.0,
      .unit = "findings",
      .sentence = fmt::format("No marker of {} lies where a body cannot have it; a single one 50 mm "
                              "off would be seen in {:.0f} % of markers and directions.",
                              name, 100.0 * judgement->seen_at_50_mm)};
  if (found > 0) {
    std::vector<std::string> sentences;
    if (judgement->mirrored) sentences.push_back(motion::describe_mirrored(name));
    for (const auto& finding : judgement->findings) sentences.push_back(motion::describe(finding, name));
    const bool still_is_wrong =
        judgement->mirrored || std::ranges::any_of(judgement->findings, [](const auto& finding) {
          return finding.where == motion::MistakeIn::still;
        });
    const std::string all = join(sentences, "; ");
    gate.sentence =
        still_is_wrong
            ? fmt::format(
                  "The static trial cannot be built on: {}. Everything below takes it as it is; label "
                  "it again or leave the marker out.",
                  all)
            : fmt::format(
                  "The static trial and the movement beside it contradict each other: {}. Everything "
                  "below takes both as they are; label again the one that is wrong, or leave the "
                  "marker out.",
                  all);
    remarks.warnings.push_back(gate.sentence);
  }
  remarks.gates.push_back(std::move(gate));
  return judgement;
}

Result<std::vector<motion::FoundationFinding>> find_exchanged_pairs(const std::string& name,
                                                                    const data::Trajectories& recording) {
  auto found = motion::judge_movement(motion::body_of_names(legs_of(recording.names)), recording);
  if (!found) return fail_at(name, found.error());
  return found;
}

int side_by_body(const data::Trajectories& recording, std::int64_t one, std::int64_t other) {
  const std::string &a = recording.names[at(one)], &b = recording.names[at(other)];
  const auto names = is_of_legs(a) && is_of_legs(b) ? legs_of(recording.names) : recording.names;
  const auto score = motion::score_exchange(motion::body_of_names(names), recording, a, b);
  const double least = motion::FoundationOptions{}.least_score;
  if (!score || std::abs(*score) < least) return 0;
  return *score < 0.0 ? 1 : -1;
}

Result<std::vector<motion::FoundationFinding>> judge_recording(const std::string& name,
                                                               const data::Trajectories& recording,
                                                               const std::string& consequence,
                                                               Remarks& remarks) {
  auto found = find_exchanged_pairs(name, recording);
  if (!found || found->empty()) return found;
  std::vector<std::string> sentences;
  for (const auto& finding : *found) sentences.push_back(motion::describe(finding, name));
  data::Gate gate{.name = "recording",
                  .passed = false,
                  .value = static_cast<double>(found->size()),
                  .bound = 0.0,
                  .unit = "findings",
                  .sentence = fmt::format("{}; {}: label them again.", join(sentences, "; "), consequence)};
  remarks.warnings.push_back(gate.sentence);
  remarks.gates.push_back(std::move(gate));
  return found;
}

void note_mirrored(const std::string& name, const motion::StandingBody& body,
                   const data::Trajectories& recording, std::vector<std::string>& warnings) {
  if (motion::shows_mirrored_body(body, recording)) warnings.push_back(motion::describe_mirrored(name));
}

}  // namespace kinemark::workflow
