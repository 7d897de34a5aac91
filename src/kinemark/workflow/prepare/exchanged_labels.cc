// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/exchanged_labels.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/data/frame_list.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/workflow/foundations/foundation_gate.h"

namespace kinemark::workflow {
namespace {

/// Frames that a finding is about, counted from the trial's first.
std::vector<std::int64_t> frames_of(const data::Finding& finding) {
  if (!finding.frames.empty()) return finding.frames;
  std::vector<std::int64_t> frames;
  for (auto f = finding.first_frame; f <= finding.last_frame; ++f) frames.push_back(f);
  return frames;
}

/// How a sample was made, and that it carried another marker's label.
void note_exchange(data::Trajectories& markers, std::int64_t frame, const std::string& name,
                   const std::string& other) {
  const auto marker = markers.find(name);
  if (marker < 0 || !markers.present(frame, marker)) return;
  const std::string before(markers.made_by(frame, marker));
  markers.set_method(frame, marker,
                     fmt::format("{}{}exchanged with {}", before, before.empty() ? "" : ", ", other));
}

}  // namespace

data::Edit edit_of(const data::Finding& swap, const data::Trial& trial) {
  data::Edit edit{.kind = data::EditKind::swap, .marker = swap.subject, .other = swap.partner};
  if (swap.frames.empty()) {
    edit.first_frame = trial.first_frame + swap.first_frame;
    edit.last_frame = trial.first_frame + swap.last_frame;
    return edit;
  }
  auto numbers = swap.frames;
  for (auto& number : numbers) number += trial.first_frame;
  edit.frames = data::format_frame_list(numbers);
  return edit;
}

std::vector<data::Finding> sure_swaps(std::span<const data::Finding> findings, double sure) {
  std::vector<data::Finding> swaps;
  for (const auto& finding : findings)
    if (finding.kind == data::FindingKind::label_swap && !(finding.confidence < sure))
      swaps.push_back(finding);
  return swaps;
}

Result<std::vector<data::Finding>> find_label_swaps(const data::Trial& trial) {
  auto found = trajectory::screen(trial.markers, {.zeros = false,
                                                  .stuck = false,
                                                  .duplicated_frames = false,
                                                  .clock_jumps = false,
                                                  .unit_slips = false,
                                                  .spikes = false,
                                                  .side = side_by_body});
  if (!found) return found;
  std::erase_if(*found, [](const auto& f) { return f.kind != data::FindingKind::label_swap; });
  return found;
}

Status exchange_back(data::Trial& trial, std::span<const data::Finding> swaps) {
  if (swaps.empty()) return {};
  std::vector<data::Edit> edits;
  for (const auto& swap : swaps) edits.push_back(edit_of(swap, trial));
  auto edited = trajectory::apply_edits(trajectory::EditedTrial{.trial = trial}, edits);
  if (!edited) return std::unexpected(edited.error());
  trial = std::move(edited->trial);
  for (const auto& swap : swaps)
    for (const auto frame : frames_of(swap)) {
      note_exchange(trial.markers, frame, swap.subject, swap.partner);
      note_exchange(trial.markers, frame, swap.partner, swap.subject);
    }
  return {};
}

}  // namespace kinemark::workflow
