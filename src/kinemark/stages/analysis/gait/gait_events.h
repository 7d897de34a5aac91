// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of walking from all that tells of them: plates, markers, the file; and how far they agree.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"
#include "kinemark/stages/analysis/gait/kinematic_events.h"

namespace kinemark::analysis {

/// Whose events are taken.
enum class EventChoice : std::uint8_t {
  best,    ///< of each instant the plate's, where one saw it, else the markers'; the file's where neither is
  plates,  ///< plates alone
  kinematics,  ///< markers alone
  file,        ///< the file's alone
};
/// "best", "plates", "kinematics" or "file".
[[nodiscard]] std::string_view to_string(EventChoice choice);
/// The choice of that name; Code::usage, with all names, for another.
[[nodiscard]] Result<EventChoice> parse_event_choice(std::string_view name);

/// The error of a method's times against plates, of one recording.
struct MethodError {
  double offset_s = 0.0;     ///< subtracted from its times: what plates showed, 0 without them
  double offset_sd_s = 0.0;  ///< common to all events of its kind
  double event_sd_s = 0.0;   ///< of each event by itself
};

/// Events of one kind by one method.
struct KinematicChoice {
  EventMethod method = EventMethod::foot_velocity;  ///< that was chosen
  MethodError error;                                ///< of it
  int compared = 0;                                 ///< events that plates saw too
};

/// How two sources differ over the instants of one kind that both tell.
struct Agreement {
  std::string what;     ///< "Foot Strike: Zeni 2008 against O'Connor 2007"
  int count = 0;        ///< of instants
  double mean_s = 0.0;  ///< the first less the second
  double sd_s = kNaN;   ///< of the differences, N - 1; NaN of one
  double most_s = 0.0;  ///< the largest difference, without sign
};

/// Events of a recording by one choice.
struct EventsFound {
  std::vector<data::GaitEvent> events;  ///< ascending in time
  std::vector<std::int64_t> window;     ///< of each event: in swings of its side and kind; -1: not by markers
  std::array<KinematicChoice, 2> chosen;  ///< for strike, for leaving
  std::array<FootSwings, 2> swings;       ///< left, right
  Ground ground;                          ///< ground_velocity()
  std::vector<Agreement> agreement;       ///< between sources, between methods
};

/// The file's own events of feet: "Foot Strike", "Foot Off", "Toe Off", "Heel Strike" with their sides, or
/// "LHS", "RTO" and the like; others are not about feet. An event outside the recording, and one that follows
/// another of its kind and side with none between, is left out and told.
struct FileEvents {
  std::vector<data::GaitEvent> events;  ///< ascending in time; SD not known
  std::vector<std::string> notes;       ///< one sentence each
};
/// @param events  of the file
/// @param time    of the recording
[[nodiscard]] FileEvents events_of_file(std::span<const data::Event> events, const TimeBase& time);

/// Find the events of all feet.
///
/// For each kind, the method is the one that agrees best with the plates: each has an offset and errors of
/// events, both normal (docs/theory/gait.md has their SDs), and the method of the greatest likelihood is
/// taken. Without plates, strike is by O'Connor 2007 and leaving by Zeni 2008, else by the next that finds
/// any. The offset to plates is taken off, shrunk by its variance; the SD of events is updated by what
/// differs from plates. Without them, by what differs between the two methods preferred, whose mean
/// difference the SD of the offset is at least half of. Noise is not in these SDs: analyze_gait() adds it.
///
/// @param of_plates, of_file  what they tell; their events are compared, and taken as `choice` says
[[nodiscard]] EventsFound find_gait_events(const GaitPaths& paths, std::span<const data::GaitEvent> of_plates,
                                           std::span<const data::GaitEvent> of_file, EventChoice choice);

/// In words: "Foot Off: Zeni 2008 and O'Connor 2007 differ by -8 +- 5 ms in 6 events, by 14 ms at most".
[[nodiscard]] std::string sentence_of(const Agreement& agreement);

}  // namespace kinemark::analysis
