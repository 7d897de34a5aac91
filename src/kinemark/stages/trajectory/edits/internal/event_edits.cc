// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/internal/event_edits.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>

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

}  // namespace kinemark::trajectory::internal
