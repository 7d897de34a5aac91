// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/prepare.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/data/resample_forces.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/screen_axes.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::workflow {
namespace {

Status take_edits(const PrepareOptions& options, data::Recording& recording) {
  if (options.edits.empty()) return {};
  const auto in_force = data::EditList{.recording = {}, .edits = options.edits}.edits_in_force();
  if (!in_force) return std::unexpected(in_force.error());
  return apply_edits(recording, *in_force, options.seed, options.threads);
}

/// Which way is up as it is said, beside what the plates say of it.
void state_up(const Vertical& stated, data::Recording& recording) {
  if (const auto plates = vertical_of_plates(recording.trial); plates && !plates->up.isApprox(stated.up))
    recording.notes.push_back(fmt::format("--up says that {} points up, {} say {}",
                                          name_of_direction(stated.up), plates->from,
                                          name_of_direction(plates->up)));
  set_screen_up(recording.trial, stated.up);
  recording.up = stated.up;
}

void turn_axes(const AxesChoice& axes, data::Recording& recording) {
  if (const auto stated = stated_vertical(axes)) state_up(*stated, recording);
  if (axes.rotate.empty()) return;
  const auto rotation = parse_rotation(axes.rotate).value();  // it was checked
  turn(recording.trial, rotation);
  if (recording.plates) turn(*recording.plates, rotation);
  recording.notes.push_back(fmt::format("the recording was turned: {}", axes.rotate));
}

Status hold(const HeldFacts& facts, data::Recording& recording) {
  auto found = find_contradictions(recording, facts);
  if (!found) return std::unexpected(found.error());
  std::ranges::copy(*found, std::back_inserter(recording.notes));
  std::ranges::move(*found, std::back_inserter(recording.contradicted));
  return {};
}

}  // namespace

Status PrepareOptions::check() const {
  if (auto s = selection.check(); !s) return s;
  return axes.check();
}

Result<data::Recording> prepare(data::Recording recording, const PrepareOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = take_edits(options, recording); !s) return std::unexpected(s.error());
  if (options.one_time)
    if (auto note = bring_to_one_time(recording.trial.markers); !note.empty())
      recording.notes.push_back(std::move(note));
  if (auto s = take_selection(options.selection, recording.trial); !s) return std::unexpected(s.error());
  // Forces stand on the frames that are left.
  const auto& time = recording.trial.markers.time;
  if (recording.plates && recording.plates->time != time)
    recording.plates = resample(*recording.plates, time);
  turn_axes(options.axes, recording);
  if (auto s = hold(options.facts, recording); !s) return std::unexpected(s.error());
  return recording;
}

Status apply_edits(data::Recording& recording, std::span<const data::Edit> in_force, std::uint64_t seed,
                   int threads) {
  auto edited = trajectory::apply_edits(trajectory::EditedTrial{.trial = recording.trial}, in_force,
                                        {.seed = seed, .threads = threads});
  if (!edited) return std::unexpected(edited.error());
  recording.trial = std::move(edited->trial);
  recording.edits.in_force += in_force.size();
  std::ranges::move(edited->regions, std::back_inserter(recording.edits.regions));
  for (const auto& edit : in_force)
    if (edit.kind == data::EditKind::swap) recording.edits.swapped.emplace_back(edit.marker, edit.other);
  std::ranges::move(edited->notes, std::back_inserter(recording.notes));
  return {};
}

std::optional<Vertical> stated_vertical(const AxesChoice& axes) {
  if (axes.up.empty() || axes.up == "auto") return std::nullopt;
  return Vertical{.up = parse_axis(axes.up).value(), .from = "--up"};
}

}  // namespace kinemark::workflow
