// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which markers of a recording are those of the feet and of the pelvis.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::analysis {

/// What a marker stands for, and its name in the recording: {"left_heel", "L_FCC"}.
using MarkerRole = std::pair<std::string, std::string>;

/// "left_heel", "left_toe", "left_ankle", the same of "right_", and "sacrum".
[[nodiscard]] std::span<const std::string_view> gait_roles();

/// Which places of a foot its two markers are at: how events of it are late or early depends on that.
enum class FootSet : std::uint8_t {
  heel_and_toe,
  ankle_and_toe,  ///< no heel is seen
  toe_alone,      ///< the forefoot's stands for both
  rear_alone,     ///< that of heel or ankle stands for both
  by_place,       ///< found by where they are: which is which is not known
};

/// Markers of one foot; indices into the recording's, -1 where there is none.
struct FootMarkers {
  std::int64_t heel = -1;                 ///< at the heel, else what stands for it
  std::int64_t toe = -1;                  ///< at the forefoot or the toes, else what stands for them
  FootSet set = FootSet::heel_and_toe;    ///< what they are
  std::vector<std::int64_t> passed_over;  ///< at heel or toe, but seen too little
  std::int64_t ankle = -1;                ///< outer one, beside heel and toe: it tells which is which
  std::int64_t knee = -1;                 ///< of the same side
  /// Whether events can be found of it.
  [[nodiscard]] bool complete() const { return heel >= 0 && toe >= 0; }
  /// Whether they are two markers, so that a foot points somewhere.
  [[nodiscard]] bool points() const { return complete() && heel != toe; }
};

/// Markers of walking.
struct GaitMarkers {
  std::array<FootMarkers, 2> feet;   ///< left, right
  std::vector<std::int64_t> pelvis;  ///< whose mean stands for the pelvis: all others, where none is named
  std::vector<std::int64_t> front, back;  ///< of the pelvis; empty: not named
  bool sides_known = true;                ///< false: no name tells left from right
  std::string person;                     ///< before the colon of its names; empty: one person
  std::vector<std::string>
      notes;  ///< what stands for what, which foot is not there, who is; one sentence each

  /// Of one foot.
  [[nodiscard]] const FootMarkers& foot(data::Side side) const { return feet[data::index_of(side)]; }
};

/// Find them by their usual names (Plug-in Gait, Helen Hayes, Cleveland Clinic, OpenSim, CMU, Visual3D's IOR,
/// pose estimators), whatever their case, separators and person's prefix, preferring the markers that are
/// seen; feet of other names by their place. What is given takes precedence. Of several people, told apart by
/// what stands before the colon of their names, the one with a given marker is taken, else the one whose feet
/// are seen most; the others are told.
///
/// @param given  roles of gait_roles() and names in the recording
/// @return  Code::usage for a role that is none (the nearest are told); Code::bad_input for a given name that
///          the recording does not have, and where no foot is found by name or place.
[[nodiscard]] Result<GaitMarkers> find_gait_markers(const data::Trajectories& markers,
                                                    std::span<const MarkerRole> given = {});

}  // namespace kinemark::analysis
