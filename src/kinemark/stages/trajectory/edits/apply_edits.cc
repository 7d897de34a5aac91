// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/apply_edits.h"

#include <algorithm>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/trajectory/edits/internal/marker_edits.h"
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

namespace kinemark::trajectory {
namespace {

using data::EditKind;

Status crop(EditedTrial& state, const data::Edit& edit) {
  auto& trial = state.trial;
  const auto frames = internal::frames_of(edit, trial);
  if (!frames) return std::unexpected(frames.error());
  keep_frames(trial, *frames);
  std::erase_if(state.regions, [&](const data::Region& region) {
    return region.last_frame < trial.first_frame || region.first_frame > trial.last_frame();
  });
  for (auto& region : state.regions) {
    region.first_frame = std::max(region.first_frame, trial.first_frame);
    region.last_frame = std::min(region.last_frame, trial.last_frame());
  }
  return {};
}

/// A region that is there already gets the new frames.
Status name_region(EditedTrial& state, const data::Edit& edit) {
  if (const auto frames = internal::frames_of(edit, state.trial); !frames)
    return std::unexpected(frames.error());
  data::Region region{.name = edit.name, .first_frame = *edit.first_frame, .last_frame = *edit.last_frame};
  const auto same = std::ranges::find(state.regions, edit.name, &data::Region::name);
  if (same == state.regions.end())
    state.regions.push_back(std::move(region));
  else
    *same = std::move(region);
  return {};
}

Status apply(EditedTrial& state, const data::Edit& edit, const EditOptions& options) {
  if (auto s = edit.check(); !s) return s;
  switch (edit.kind) {
    case EditKind::relabel:
      return internal::relabel(state.trial, edit);
    case EditKind::swap:
      return internal::swap_markers(state.trial, edit);
    case EditKind::cut:
      return internal::cut(state.trial, edit);
    case EditKind::fill:
      return internal::fill(state.trial, edit, options, state.notes);
    case EditKind::unfill:
      return internal::unfill(state.trial, edit);
    case EditKind::crop:
      return crop(state, edit);
    case EditKind::mark_event:
      return internal::mark_event(state.trial, edit);
    case EditKind::move_event:
      return internal::move_event(state.trial, edit);
    case EditKind::delete_event:
      return internal::delete_event(state.trial, edit);
    case EditKind::region:
      return name_region(state, edit);
    case EditKind::undo:
    case EditKind::redo:
      break;
  }
  return fail(Code::bad_input, "is for a list of edits, not for a recording");
}

}  // namespace

Result<EditedTrial> apply_edits(EditedTrial state, std::span<const data::Edit> in_force,
                                const EditOptions& options) {
  const auto total = std::ssize(in_force);
  for (std::int64_t i = 0; i < total; ++i) {
    if (options.progress && !options.progress(i, total))
      return fail(Code::cancelled, "applying edits was stopped");
    const data::Edit& edit = in_force[at(i)];
    if (auto s = apply(state, edit, options); !s) {
      if (s.error().code == Code::cancelled) return std::unexpected(s.error());
      return fail_at(place_of(edit) + ": " + std::string(to_string(edit.kind)), s.error());
    }
  }
  return state;
}

Result<EditedTrial> apply_edits(data::Trial trial, const data::EditList& list, const EditOptions& options) {
  const auto in_force = list.edits_in_force();
  if (!in_force) return std::unexpected(in_force.error());
  return apply_edits(EditedTrial{.trial = std::move(trial)}, *in_force, options);
}

}  // namespace kinemark::trajectory
