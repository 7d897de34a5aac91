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

namespace kinemark::analysis {

/// What a marker stands for, and its name in the recording: {"left_heel", "L_FCC"}.
using MarkerRole = std::pair<std::string, std::string>;

/// "left_heel", "left_toe", "left_ankle", the same of "right_", and "sacrum".
[[nodiscard]] std::span<const std::string_view> gait_roles();

/// Markers of one foot; indices into the recording's, -1 where there is none.
struct FootMarkers {
  std::int64_t heel = -1;  ///< at the heel, else at the ankle
  std::int64_t toe = -1;   ///< at the forefoot or the toes
  /// Whether events can be found of it.
  [[nodiscard]] bool complete() const { return heel >= 0 && toe >= 0; }
};

/// Markers of walking.
struct GaitMarkers {
  std::array<FootMarkers, 2> feet;  ///< left, right
  /// What may stand for the pelvis, best first: the mean of one set of markers. May be empty.
  std::vector<std::vector<std::int64_t>> pelvis;
  std::vector<std::string> notes;  ///< what stands for what, and which foot is not there; one sentence each

  /// Of one foot.
  [[nodiscard]] const FootMarkers& foot(data::Side side) const { return feet[data::index_of(side)]; }
};

/// Find them by their usual names (Plug-in Gait, Helen Hayes, Cleveland Clinic, OpenSim, CMU, Visual3D's IOR,
/// pose estimators), whatever their case, separators and subject's prefix; what is given takes precedence.
///
/// @param given  roles of gait_roles() and names in the recording
/// @return  Code::usage for a role that is none (the nearest are told); Code::bad_input for a given name that
///          the recording does not have, and where neither foot has a marker at heel or ankle and one at the
///          toes: the sentence names what is missing.
[[nodiscard]] Result<GaitMarkers> find_gait_markers(const std::vector<std::string>& names,
                                                    std::span<const MarkerRole> given = {});

}  // namespace kinemark::analysis
