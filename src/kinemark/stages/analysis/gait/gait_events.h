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

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trial.h"

namespace kinemark::analysis {

struct MarkerEvents;

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

/// How two sources differ over the instants of one kind that both tell.
struct Agreement {
  std::string what;     ///< "Foot Strike: markers and the plates"
  int count = 0;        ///< of instants
  double mean_s = 0.0;  ///< the first less the second
  double sd_s = kNaN;   ///< of the differences, N - 1; NaN of one
  double most_s = 0.0;  ///< the largest difference, without sign
};

/// Offset of the markers' events of one kind against the plates of the recording, taken off where `best` is
/// asked for.
struct PlateOffset {
  double offset_s = 0.0;  ///< subtracted from the markers' times; 0: nothing was
  double share = 1.0;     ///< of EventError::kind_s that is left
  int compared = 0;       ///< events that the plates saw too
};

/// Events of a recording by one choice.
struct EventsFound {
  std::vector<data::GaitEvent> events;  ///< ascending in time
  std::vector<std::int64_t> edge;       ///< of each event: in MarkerEvents::edges; -1: not by markers
  std::vector<data::EventError> error;  ///< of each event, besides what noise does to it
  std::array<PlateOffset, 2> offset;    ///< of strikes, of leavings
  std::vector<Agreement> agreement;     ///< between sources
  bool out_of_step = false;             ///< plates and markers do not run on one clock
  std::vector<std::string> notes;  ///< on plates out of step, what was taken off, what the file's err by,
                                   ///< labels that markers contradict
};

/// What a laboratory's stored events usually err by, standard deviations: all of a kind in a recording the
/// same way, as those of markers do, and each by itself (docs/theory/gait.md).
inline constexpr double kFileOffset_s = 0.016, kFileOwn_s = 0.01;

/// The file's own events of feet: "Foot Strike", "Foot Off", "Toe Off", "Heel Strike" with their sides, or
/// "LHS", "RTO" and the like; others are not about feet. An event outside the recording, and one that follows
/// another of its kind and side within 0.3 s with none between, is left out and told. Where one follows
/// later, both stand, and the one that is not labelled between them is told, in a file that labels such of
/// either foot.
struct FileEvents {
  std::vector<data::GaitEvent>
      events;  ///< ascending in time, with kFileOffset_s, kFileOwn_s and a frame in the SD
  std::vector<std::string> notes;  ///< one sentence each
};
/// @param events  of the file
/// @param time    of the recording
[[nodiscard]] FileEvents events_of_file(std::span<const data::Event> events, const TimeBase& time);

/// Choose among events of markers, plates and file.
///
/// `best` takes a plate's event in place of the markers' of the same instant (nearest, within 0.15 s), and
/// takes the mean difference of the others to the plates off, shrunk by what one laboratory's offset and the
/// errors of events are worth (docs/theory/gait.md): said in `notes`. `kinematics` is what the markers tell,
/// whatever plates and file hold.
///
/// Plates and markers are out of step where strikes and leavings differ by more than 30 ms on average, both
/// the same way: `best` then takes no event of a plate.
///
/// Events of the file err by what they differ by from plates in step and from markers that saw the same
/// instants, with a laboratory's usual error before: its mean and scatter are in their SDs, their times stay.
///
/// @param of_plates, of_file  what they tell; their events are compared, and taken as `choice` says
[[nodiscard]] EventsFound find_gait_events(const MarkerEvents& of_markers,
                                           std::span<const data::GaitEvent> of_plates,
                                           std::span<const data::GaitEvent> of_file, EventChoice choice);

/// In words: "Foot Off: markers and the plates differ by -8 +- 5 ms in 6 events, by 14 ms at most".
[[nodiscard]] std::string sentence_of(const Agreement& agreement);

}  // namespace kinemark::analysis
