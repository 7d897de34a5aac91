// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/marker_edits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/data/frame_list.h"
#include "kinemark/data/name_index.h"
#include "kinemark/stages/trajectory/edits/internal/samples.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kHalfFrame = 0.5 + 1e-6;  // with what times lose in decimal digits

std::string name_of(const std::string& label, const std::string& context) {
  return context.empty() ? fmt::format("'{}'", label) : fmt::format("'{}' ({})", label, context);
}

/// The event of that name nearest to a time, but for one that does not count.
std::optional<std::size_t> nearest(const data::Trial& trial, const data::Edit& edit, double time_s,
                                   std::optional<std::size_t> but = std::nullopt) {
  std::optional<std::size_t> best;
  const auto distance_s = [&](std::size_t i) { return std::abs(trial.events[i].time_s - time_s); };
  for (std::size_t i = 0; i < trial.events.size(); ++i) {
    const auto& event = trial.events[i];
    if (event.label != edit.label || event.context != edit.context || i == but) continue;
    if (!best || distance_s(i) < distance_s(*best)) best = i;
  }
  return best;
}

bool is_at(const data::Trial& trial, std::size_t i, double time_s) {
  return std::abs(trial.events[i].time_s - time_s) * trial.markers.time.rate_hz <= kHalfFrame;
}

Result<std::size_t> find_event(const data::Trial& trial, const data::Edit& edit) {
  const auto found = nearest(trial, edit, edit.time_s);
  if (found && is_at(trial, *found, edit.time_s)) return *found;
  const auto instead =
      found ? fmt::format("the nearest of that name is at {:.6g} s", trial.events[*found].time_s)
            : "there is none of that name";
  return fail(Code::bad_input, fmt::format("no event {} is at {:.6g} s; {}",
                                           name_of(edit.label, edit.context), edit.time_s, instead));
}

/// Whether an event may be put there.
Status check_time(const data::Trial& trial, const data::Edit& edit, double time_s,
                  std::optional<std::size_t> moved = std::nullopt) {
  const auto& time = trial.markers.time;
  const double frame = (time_s - time.t0_s) * time.rate_hz;
  if (frame < -kHalfFrame || frame > static_cast<double>(time.frames) - 1.0 + kHalfFrame)
    return fail(Code::bad_input, fmt::format("{:.6g} s lies outside the recording, which lasts from {:.6g} "
                                             "to {:.6g} s",
                                             time_s, time.t0_s, time.time_s(time.frames - 1)));
  const auto there = nearest(trial, edit, time_s, moved);
  if (there && is_at(trial, *there, time_s))
    return fail(Code::bad_input, fmt::format("an event {} is at {:.6g} s already; need another time",
                                             name_of(edit.label, edit.context), trial.events[*there].time_s));
  return {};
}

using data::SampleState;

/// A marker that has to be there.
/// @param index  of the recording's markers
Result<std::int64_t> find_marker(const data::Trial& trial, const data::NameIndex& index,
                                 const std::string& name) {
  if (const auto marker = index.find(name); marker >= 0) return marker;
  if (std::ranges::find(trial.channels.names, name) != trial.channels.names.end())
    return fail(Code::bad_input, fmt::format("'{}' is an output of a model; need a marker", name));
  const auto near = nearest_names(name, trial.markers.names);
  if (index.ambiguous(name) || near.empty())
    return fail(Code::bad_input,
                fmt::format("no marker is named '{}'; there are {}", name, index.instead_of(name)));
  return fail(Code::bad_input, fmt::format("no marker is named '{}'; nearest: {}", name, join(near)));
}

/// "frame 5", "frames 5 to 8", in the file's own numbers.
std::string words_of(const FrameSpan& frames, const data::Trial& trial) {
  const auto first = trial.first_frame + frames.first, last = first + frames.count - 1;
  return first == last ? fmt::format("frame {}", first) : fmt::format("frames {} to {}", first, last);
}

/// A marker in some frames.
struct Target {
  std::int64_t marker = 0;
  FrameSpan frames;
  std::string name;  ///< of the marker, as the recording has it
};

/// @param index  of the recording's markers
Result<Target> target_of(const data::Edit& edit, const data::Trial& trial, const data::NameIndex& index) {
  const auto frames = frames_of(edit, trial);
  if (!frames) return std::unexpected(frames.error());
  const auto marker = find_marker(trial, index, edit.marker);
  if (!marker) return std::unexpected(marker.error());
  return Target{.marker = *marker, .frames = *frames, .name = trial.markers.names[at(*marker)]};
}

Result<Target> target_of(const data::Edit& edit, const data::Trial& trial) {
  return target_of(edit, trial, data::NameIndex(trial.markers.names));
}

template <class Wanted>
std::vector<std::int64_t> frames_where(const FrameSpan& frames, const Wanted& wanted) {
  std::vector<std::int64_t> found;
  for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f)
    if (wanted(f)) found.push_back(f);
  return found;
}

/// The frames of a target that are `wanted`; none: there is no `what`.
template <class Wanted>
Result<std::vector<std::int64_t>> some_frames(const Target& target, const data::Trial& trial,
                                              std::string_view what, const Wanted& wanted) {
  auto found = frames_where(target.frames, wanted);
  if (!found.empty()) return found;
  return fail(Code::bad_input, fmt::format("'{}' has no {} in {}; need one at least", target.name, what,
                                           words_of(target.frames, trial)));
}

Status check_frame(std::int64_t frame, const data::Trial& trial) {
  if (frame >= trial.first_frame && frame <= trial.last_frame()) return {};
  return fail(Code::bad_input, fmt::format("frame {} is not there; the recording has frames {} to {}", frame,
                                           trial.first_frame, trial.last_frame()));
}

/// The frames of an edit, listed or as a range.
Result<std::vector<FrameSpan>> spans_of(const data::Edit& edit, const data::Trial& trial) {
  if (edit.frames.empty()) {
    const auto frames = frames_of(edit, trial);
    if (!frames) return std::unexpected(frames.error());
    return std::vector{*frames};
  }
  if (trial.markers.frames() == 0) return fail(Code::bad_input, "the recording has no frames");
  const auto listed = data::parse_frame_list(edit.frames);
  if (!listed) return std::unexpected(listed.error());
  std::vector<FrameSpan> spans;
  for (const auto frame : *listed) {
    if (auto s = check_frame(frame, trial); !s) return std::unexpected(s.error());
    spans.push_back({.first = frame - trial.first_frame, .count = 1});
  }
  return spans;
}

void remove_marker(data::Trial& trial, std::int64_t marker) {
  std::vector<std::int64_t> kept;
  for (std::int64_t m = 0; m < trial.markers.markers(); ++m)
    if (m != marker) kept.push_back(m);
  keep_markers(trial, kept);
}

/// A sample that was filled, as it was before.
void take_back_fill(data::Trajectories& filled, std::int64_t frame, std::int64_t marker,
                    const data::Trajectories& before) {
  const auto i = before.index(frame, marker);
  filled.set_missing(frame, marker, before.state[i]);
  std::fill_n(filled.covariance.begin() + 6 * static_cast<std::int64_t>(i), 6, kNaN);
  filled.method[i] = before.method.empty() ? std::uint8_t{0} : before.method[i];
}

/// The samples of both would be in one place.
Status check_no_overlap(const data::Trial& trial, std::int64_t from, std::int64_t to,
                        const FrameSpan& frames) {
  const auto both = frames_where(
      frames, [&](std::int64_t f) { return trial.markers.present(f, from) && trial.markers.present(f, to); });
  if (both.empty()) return {};
  return fail(Code::bad_input,
              fmt::format("both '{}' and '{}' have samples in {}, the first of them frame {}; need a range "
                          "where one of them has none, or swap",
                          trial.markers.names[at(from)], trial.markers.names[at(to)],
                          counted(std::ssize(both), "frame"), trial.first_frame + both.front()));
}

}  // namespace

Status mark_event(data::Trial& trial, const data::Edit& edit) {
  if (auto s = check_time(trial, edit, edit.time_s); !s) return s;
  trial.events.push_back({.label = edit.label, .context = edit.context, .time_s = edit.time_s});
  return {};
}

Status move_event(data::Trial& trial, const data::Edit& edit) {
  const auto event = find_event(trial, edit);
  if (!event) return std::unexpected(event.error());
  if (auto s = check_time(trial, edit, edit.to_s, *event); !s) return s;
  trial.events[*event].time_s = edit.to_s;
  return {};
}

Status delete_event(data::Trial& trial, const data::Edit& edit) {
  const auto event = find_event(trial, edit);
  if (!event) return std::unexpected(event.error());
  trial.events.erase(trial.events.begin() + static_cast<std::ptrdiff_t>(*event));
  return {};
}

Result<FrameSpan> frames_of(const data::Edit& edit, const data::Trial& trial) {
  if (trial.markers.frames() == 0) return fail(Code::bad_input, "the recording has no frames");
  const auto first = edit.first_frame.value_or(trial.first_frame),
             last = edit.last_frame.value_or(trial.last_frame());
  for (const auto frame : {first, last})
    if (auto s = check_frame(frame, trial); !s) return std::unexpected(s.error());
  return FrameSpan{.first = first - trial.first_frame, .count = last - first + 1};
}

Status relabel(data::Trial& trial, const data::Edit& edit) {
  const data::NameIndex index(trial.markers.names);
  const auto target = target_of(edit, trial, index);
  if (!target) return std::unexpected(target.error());
  if (std::ranges::find(trial.channels.names, edit.other) != trial.channels.names.end())
    return fail(Code::bad_input, fmt::format("'{}' is an output of a model; need another name", edit.other));
  auto& markers = trial.markers;
  const auto from = target->marker;
  const bool whole = !edit.first_frame && !edit.last_frame;
  auto to = index.find(edit.other);
  if (to == from) to = markers.find(edit.other);  // "LASI" of "Ann:LASI" is a new name for it
  if (to == from) return fail(Code::bad_input, fmt::format("'{}' has that name already", edit.other));
  if (to < 0 && whole) {
    markers.names[at(from)] = edit.other;
    return {};
  }
  const auto is_there = [&](std::int64_t f) { return markers.present(f, from); };
  if (const auto moved = some_frames(*target, trial, "sample", is_there); !moved)
    return std::unexpected(moved.error());
  if (to >= 0)
    if (auto s = check_no_overlap(trial, from, to, target->frames); !s) return s;
  if (to < 0) {
    add_marker(trial, edit.other, from);
    to = markers.markers() - 1;
  }
  move_samples(trial, from, to, target->frames);
  if (whole) remove_marker(trial, from);
  gather_times(markers);
  return {};
}

Status swap_markers(data::Trial& trial, const data::Edit& edit) {
  const auto spans = spans_of(edit, trial);
  if (!spans) return std::unexpected(spans.error());
  const data::NameIndex index(trial.markers.names);
  const auto a = find_marker(trial, index, edit.marker), b = find_marker(trial, index, edit.other);
  if (!a) return std::unexpected(a.error());
  if (!b) return std::unexpected(b.error());
  if (*a == *b)
    return fail(Code::bad_input, fmt::format("'{}' and '{}' are one marker", edit.marker, edit.other));
  for (const FrameSpan& span : *spans) swap_samples(trial, *a, *b, span);
  gather_times(trial.markers);
  return {};
}

Status cut(data::Trial& trial, const data::Edit& edit) {
  const auto target = target_of(edit, trial);
  if (!target) return std::unexpected(target.error());
  const auto is_there = [&](std::int64_t f) { return trial.markers.present(f, target->marker); };
  const auto present = some_frames(*target, trial, "sample", is_there);
  if (!present) return std::unexpected(present.error());
  for (const auto f : *present) blank_sample(trial, f, target->marker, SampleState::rejected);
  return {};
}

Status fill(data::Trial& trial, const data::Edit& edit, const EditOptions& options,
            std::vector<std::string>& notes) {
  const auto target = target_of(edit, trial);
  if (!target) return std::unexpected(target.error());
  const auto method = edit.method.empty() ? GapMethod::automatic : parse_gap_method(edit.method);
  if (!method) return fail(Code::bad_input, method.error().message);
  if (*method == GapMethod::none) return fail(Code::bad_input, "the method 'none' fills nothing");
  auto& markers = trial.markers;
  const auto& [marker, frames, name] = *target;
  const auto missing =
      some_frames(*target, trial, "gap", [&](std::int64_t f) { return !markers.present(f, target->marker); });
  if (!missing) return std::unexpected(missing.error());
  // A person asked for this gap: it is filled whatever its length and deviation, which go with the samples.
  GapOptions gaps{.method = *method,
                  .max_gap_s = std::numeric_limits<double>::infinity(),
                  .max_sd_m = std::numeric_limits<double>::infinity(),
                  .check_labels = *method >= GapMethod::rigid,  // those before it look at no other marker
                  .seed = options.seed,
                  .threads = options.threads};
  gaps.only = {.marker = marker, .first_frame = missing->front(), .last_frame = missing->back()};
  auto filled = fill_gaps(markers, gaps);
  if (!filled) return std::unexpected(filled.error());
  const auto open =
      frames_where(frames, [&](std::int64_t f) { return !filled->trajectories.present(f, target->marker); });
  if (open.size() == missing->size())
    return fail(Code::bad_input, fmt::format("the gap of '{}' in {} cannot be filled: {}", name,
                                             words_of(frames, trial), filled->gaps.front().why_open));
  // Gaps are filled as a whole; what lies outside the range is as it was.
  auto after = trial;
  after.markers = std::move(filled->trajectories);
  for (const auto& gap : filled->gaps) {
    if (!gap.why_open.empty())
      notes.push_back(fmt::format("{}: fill: the gap of '{}' in {} stays open: {}", place_of(edit), name,
                                  words_of({.first = gap.first_frame, .count = gap.frames()}, trial),
                                  gap.why_open));
    for (auto f = gap.first_frame; f <= gap.last_frame; ++f) {
      if (!after.markers.present(f, marker)) continue;
      if (f < frames.first || f >= frames.first + frames.count)
        take_back_fill(after.markers, f, marker, markers);
      else
        forget_cameras(after, f, marker);
    }
  }
  trial = std::move(after);
  return {};
}

Status unfill(data::Trial& trial, const data::Edit& edit) {
  const auto target = target_of(edit, trial);
  if (!target) return std::unexpected(target.error());
  const auto is_filled = [&](std::int64_t f) {
    const auto state = trial.markers.state[trial.markers.index(f, target->marker)];
    return state == SampleState::interpolated || state == SampleState::model_filled;
  };
  const auto filled = some_frames(*target, trial, "filled sample", is_filled);
  if (!filled) return std::unexpected(filled.error());
  for (const auto f : *filled) blank_sample(trial, f, target->marker, SampleState::missing);
  return {};
}

}  // namespace kinemark::trajectory::internal
