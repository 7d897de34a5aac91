// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Foot strike and toe-off from the paths of markers, by published methods.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

/// How events are found, in the order in which they are preferred where nothing else decides.
enum class EventMethod : std::uint8_t {
  foot_velocity,    ///< strike: least vertical velocity of the middle of the foot, off: its greatest
                    ///< (O'Connor, Thorpe, O'Malley & Vaughan 2007, Gait & Posture 25:469)
  coordinates,      ///< strike: heel farthest before the pelvis, off: toe farthest behind it
                    ///< (Zeni, Richards & Higginson 2008, Gait & Posture 27:710)
  speed_threshold,  ///< strike: the heel's speed over the ground in the sagittal plane falls below 0.5 m/s,
                    ///< off: the toe's rises above it (Ghoussayni et al. 2004, Gait & Posture 20:266;
                    ///< threshold: Bruening & Ridge 2014, Gait & Posture 39:472)
};
/// All.
inline constexpr std::array<EventMethod, 3> kEventMethods{
    EventMethod::foot_velocity, EventMethod::coordinates, EventMethod::speed_threshold};
/// "O'Connor 2007", "Zeni 2008" or "Ghoussayni 2004".
[[nodiscard]] std::string_view to_string(EventMethod method);

/// A step of one foot: where its strike, or its leaving the ground, is to be looked for.
struct StepWindow {
  double centre = 0.0;  ///< frame at which the foot is farthest before, or behind, the other
  double first = 0.0;   ///< frames between which the event lies
  double last = 0.0;    ///< as `first`
};

/// Swings of a foot against the other one (against the pelvis, where there is no other): each time it is
/// farthest before and farthest behind along the direction of walking.
struct FootSwings {
  std::array<std::vector<StepWindow>, 2> windows;  ///< of strikes, of leaving; ascending
  double cycle = 0.0;                              ///< frames, median; 0: the foot does not walk

  /// Of one kind of event.
  [[nodiscard]] const std::vector<StepWindow>& of(data::FootEvent what) const {
    return windows[data::index_of(what)];
  }
};

/// The swings of a foot; none where it does not swing by 0.15 m or more.
[[nodiscard]] FootSwings find_swings(const GaitPaths& paths, data::Side side);

/// How the ground moves under the feet, horizontal: not at all over ground, backwards on a treadmill.
struct Ground {
  Eigen::RowVector2d velocity{kNaN,
                              kNaN};  ///< m/s, median over the middles of stances; NaN where there is none
  double sd = 0.0;  ///< m/s, of its length: half of what heels and toes, which lie flat then, differ by
};
/// From the feet while they lie flat.
[[nodiscard]] Ground ground_velocity(const GaitPaths& paths, const std::array<FootSwings, 2>& swings);

/// The event in each window, frames that need not be whole; NaN where the method finds none (no pelvis, not
/// measured there, at the edge of the recording).
/// @param ground  ground_velocity().velocity
[[nodiscard]] std::vector<double> find_in_windows(const GaitPaths& paths, data::Side side,
                                                  data::FootEvent what, EventMethod method,
                                                  const FootSwings& swings, const Eigen::RowVector2d& ground);

}  // namespace kinemark::analysis
