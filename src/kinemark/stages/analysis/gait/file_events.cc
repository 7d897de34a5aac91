// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "kinemark/stages/analysis/gait/gait_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::GaitEvent;
using data::Side;

constexpr std::array<std::string_view, 9> kStrike{
    "footstrike", "heelstrike", "initialcontact", "strike", "footcontact", "heelcontact", "hs", "fs", "ic"};
constexpr std::array<std::string_view, 5> kOff{"footoff", "toeoff", "off", "to", "fo"};
constexpr double kRepeated_s = 0.3;  // no foot makes a stride in less

std::string letters(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c >= 'A' && c <= 'Z')
      out += static_cast<char>(c - 'A' + 'a');
    else if (c >= 'a' && c <= 'z')
      out += c;
  return out;
}

std::optional<FootEvent> kind_of(std::string_view label) {
  if (std::ranges::find(kStrike, label) != kStrike.end()) return FootEvent::strike;
  if (std::ranges::find(kOff, label) != kOff.end()) return FootEvent::off;
  return std::nullopt;
}

std::optional<GaitEvent> read_event(const data::Event& event, double sd_s) {
  const std::string label = letters(event.label), context = letters(event.context);
  const auto of = [&](Side side, FootEvent what) {
    return GaitEvent{.side = side,
                     .what = what,
                     .time_s = event.time_s,
                     .sd_s = sd_s,
                     .source = data::EventSource::file,
                     .method = "the file"};
  };
  if (context == "left" || context == "right") {
    const auto what = kind_of(label);
    return what ? std::optional(of(context == "left" ? Side::left : Side::right, *what)) : std::nullopt;
  }
  for (const std::string_view side : {"left", "right", "l", "r"})
    if (label.starts_with(side))
      if (const auto what = kind_of(std::string_view(label).substr(side.size())))
        return of(side.front() == 'l' ? Side::left : Side::right, *what);
  return std::nullopt;
}

}  // namespace

FileEvents events_of_file(std::span<const data::Event> events, const TimeBase& time) {
  FileEvents out;
  const auto name_of = [](const GaitEvent& event) {
    return fmt::format("the file's event {} {} at {:.3f} s", data::to_string(event.side),
                       data::to_string(event.what), event.time_s);
  };
  const double half = 0.5 / time.rate_hz, first = time.time_s(0) - half,
               last = time.time_s(time.frames - 1) + half;
  std::vector<GaitEvent> read;
  for (const auto& event : events) {
    const auto one = read_event(event, std::hypot(kFileOffset_s, kFileOwn_s, half / std::numbers::sqrt3));
    if (!one) continue;
    if (one->time_s >= first && one->time_s <= last)
      read.push_back(*one);
    else
      out.notes.push_back(fmt::format("{} lies outside the recording, {:.3f} to {:.3f} s, and is left out",
                                      name_of(*one), time.time_s(0), time.time_s(time.frames - 1)));
  }
  std::ranges::stable_sort(read, {}, &GaitEvent::time_s);
  std::array<std::optional<GaitEvent>, 2> before;
  for (const auto& event : read) {
    auto& same_side = before[data::index_of(event.side)];
    // A file may have one kind alone; where it has both, be it of the other foot, they take turns.
    const bool turns = std::ranges::any_of(read, [&](const auto& other) { return other.what != event.what; });
    if (same_side && same_side->what == event.what) {
      const auto between =
          data::to_string(event.what == FootEvent::strike ? FootEvent::off : FootEvent::strike);
      if (event.time_s - same_side->time_s < kRepeated_s) {
        out.notes.push_back(fmt::format("{} follows another of its kind, with no {} between, and is left out",
                                        name_of(event), between));
        continue;
      }
      if (turns)
        out.notes.push_back(fmt::format("no {} {} is labelled between {} and the next at {:.3f} s",
                                        data::to_string(event.side), between, name_of(*same_side),
                                        event.time_s));
    }
    same_side = event;
    out.events.push_back(event);
  }
  return out;
}

}  // namespace kinemark::analysis
