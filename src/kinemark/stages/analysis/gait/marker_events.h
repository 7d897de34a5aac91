// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of both feet from markers alone, the kind of gait that they are of, and what could not be found.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/gait/belt.h"
#include "kinemark/stages/analysis/gait/foot_ends.h"
#include "kinemark/stages/analysis/gait/gait_kind.h"
#include "kinemark/stages/analysis/gait/kinematic_events.h"

namespace kinemark::analysis {

/// What the markers tell of a recording.
struct MarkerEvents {
  Ground ground;                        ///< under the feet
  Ground belt;                          ///< belt_velocity(): what speeds and lengths are measured against
  BeltPace pace;                        ///< of a belt whose speed changes; else without stances
  Steps steps;                          ///< swings of both feet
  GaitKind kind;                        ///< of gait, or why it is none
  FootEnds ends;                        ///< which feet have names of heel and toe exchanged
  std::vector<SwingEdge> edges;         ///< those that are seen, by side and time
  std::vector<FusedTime> fused;         ///< of each edge
  std::vector<data::GaitEvent> events;  ///< of each edge, with its whole SD
  std::array<int, 2> unseen{};          ///< by side: edges of swings where the foot is not seen
};

/// Find them: once at kFirstCutOff_hz for the pace, then smoothed at cut_off_of() it. Where no name tells the
/// sides, left is the foot on the left of where the body goes.
/// @param smoother  is left at that cut-off, its sides, and heel and toe of a foot, exchanged where they had
/// to be, and on an even belt where its speed changes
[[nodiscard]] Result<MarkerEvents> find_marker_events(GaitSmoother& smoother, const GaitMarkers& which);

/// Factor on SDs of a direction in which no plate has judged them: 1.5 backward and sideways, else 1.
[[nodiscard]] double sd_factor(GaitDirection direction);

/// What is to be said aloud, a sentence each: where a foot is hidden or held still, where a strike is missing
/// between two others, feet that do not strike or strike at different numbers, names of heel and toe, of the
/// front and the back of the pelvis, or of sides that are exchanged.
[[nodiscard]] std::vector<std::string> findings_of(const GaitSmoother& smoother, const MarkerEvents& found);

/// Which names are held against where their markers are.
enum class NamesOf : std::uint8_t {
  sides,           ///< left and right
  ends_and_sides,  ///< heel and toe, front and back of the pelvis, too; walking is measured with them
                   ///< exchanged back
};
/// Of these, that names contradict where markers are.
[[nodiscard]] std::vector<std::string> name_findings_of(const GaitSmoother& smoother,
                                                        const MarkerEvents& found, NamesOf names);

}  // namespace kinemark::analysis
