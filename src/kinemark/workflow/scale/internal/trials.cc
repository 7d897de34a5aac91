// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/internal/trials.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/data/filtering.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/workflow/foundations/foundation_gate.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

void say(const std::string& where, const std::string& note, std::vector<std::string>& warnings) {
  auto sentence = fmt::format("{}: {}", where, note);
  if (std::ranges::find(warnings, sentence) == warnings.end()) warnings.push_back(std::move(sentence));
}

}  // namespace

Status keep_measured(ScaleTrial& trial) {
  auto& recording = trial.recording;
  const auto made = note_on_upsampling(recording.trial.markers);
  if (!made) return fail_at(trial.where, made.error());
  if (made->empty()) return {};
  const auto screening =
      screen_markers(recording.trial, {.recorder_made = RecorderMade::decimate, .find_defects = false});
  if (!screening) return fail_at(trial.where, screening.error());
  if (screening->upsampling->factor() > 1)
    recording.notes.push_back(*made + "; sizes are found from measured frames alone");
  return {};
}

Status leave_out_doubtful(ScaleTrial& trial) {
  auto& recording = trial.recording;
  const auto s = leave_out_defects(recording.trial, false, recording.edits.swapped, recording.notes);
  return s ? s : Status(fail_at(trial.where, s.error()));
}

Status judge_stills(const std::vector<const ScaleTrial*>& stills, const std::optional<ScaleTrial>& motion,
                    const std::string& model_name, ScaleFound& found) {
  if (stills.empty() && !motion) return {};
  const auto body = motion::body_of_model(found.model);
  if (!body) return fail_at(model_name, body.error());
  std::vector<const data::Trajectories*> movements;
  if (motion) {
    movements.push_back(&motion->recording.trial.markers);
    add_contradictions(motion->recording.contradicted, found.remarks.gates);
  }
  for (const auto* still : stills) {
    add_contradictions(still->recording.contradicted, found.remarks.gates);
    auto judgement =
        judge_static_trial(still->name, *body, still->recording.trial.markers, movements, found.remarks);
    if (!judgement) return std::unexpected(judgement.error());
    found.static_trials.push_back({.file = still->name, .judgement = std::move(*judgement)});
  }
  return {};
}

Status bring_to_model(const AxesChoice& axes, const std::string& model_name, ScaleTrial& trial,
                      ScaleFound& found) {
  const auto model = model::Model::compile(found.model);
  if (!model) return fail_at(model_name, model.error());
  auto& recording = trial.recording;
  const auto brought = bring_into_axes(axes, trial.where, recording.trial, *model);
  if (!brought) return std::unexpected(brought.error());
  auto& warnings = found.remarks.warnings;
  if (const auto note = data::note_on_noise(recording.trial.markers); !note.empty())
    say(trial.where, note, warnings);
  for (const auto& note : recording.notes) say(trial.where, note, warnings);
  if (!brought->note.empty()) say(trial.where, brought->note, warnings);
  return {};
}

}  // namespace kinemark::workflow
