// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cycles and footprints of walking: what its measures are computed from.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/gait_event.h"

namespace kinemark::analysis {

struct GaitPaths;

/// Where a heel stands, on ground that does not move.
struct Footprint {
  Eigen::Vector2d x{kNaN, kNaN};  ///< m, horizontal; NaN where not seen
  double sd = 0.0;                ///< m, of each coordinate: by how much the heel moves while it stands
};

/// From one strike of a foot to its next. Times on the recording's clock, s; NaN where not seen.
struct GaitCycle {
  data::Side side = data::Side::left;  ///< of the foot
  double start_s = kNaN;               ///< its strike
  double end_s = kNaN;                 ///< its next strike
  double off_s = kNaN;                 ///< it leaves the ground
  double other_off_s = kNaN;           ///< the other foot leaves the ground, before `other_strike_s`
  double other_strike_s = kNaN;        ///< the other foot's strike
  Footprint print;                     ///< of this step
  Footprint other_print;               ///< of the other foot's step
  Footprint next_print;                ///< of the next step of this foot
  bool backward = false;               ///< the feet point against the way that they go

  /// From print to print of this foot, m.
  [[nodiscard]] double stride_length() const { return (next_print.x - print.x).norm(); }
  /// Of the other foot's step, along the line between this foot's prints, m.
  [[nodiscard]] double step_length() const;
  /// Of the other foot's print from the line between this foot's, m; negative where the feet cross.
  [[nodiscard]] double step_width() const;
};

/// From one strike of a foot to its next, where another one is missing between: no stride.
struct Bridge {
  data::Side side = data::Side::left;  ///< of the foot
  double start_s = 0.0;                ///< its strike
  double end_s = 0.0;                  ///< the next that was found
  double strides = 0.0;                ///< usual ones that it lasts
};
/// Pairs of strikes that lie more than 1.6 times the median of both feet apart, or that two leavings of the
/// foot lie between; by side and time.
/// @param events  ascending in time
[[nodiscard]] std::vector<Bridge> find_bridges(std::span<const data::GaitEvent> events);

/// The two strikes that a cycle goes from and to, as numbers of events.
struct Stride {
  std::size_t start = 0;  ///< of the events
  std::size_t end = 0;    ///< the same foot's next
};
/// Strides of both feet, ascending by side and time. One lasts 0.3 to 6 s and is no bridge of find_bridges().
/// @param events  ascending in time
[[nodiscard]] std::vector<Stride> find_strides(std::span<const data::GaitEvent> events);

/// Cycles of these strides, in their order, where the times of the events are others than those that the
/// strides were found in: what is a stride is judged once, else errors of events would choose the short ones.
/// @param events  a time that is NaN is that of no event
[[nodiscard]] std::vector<GaitCycle> cycles_of(const GaitPaths& paths,
                                               std::span<const data::GaitEvent> events,
                                               std::span<const Stride> strides,
                                               const Eigen::RowVector2d& ground, bool backward = false);

/// Cycles of both feet, ascending by side and time, of find_strides().
///
/// A footprint is the mean place of the heel from 20 to 45 % of the stance (of 60 % of the cycle, where the
/// foot's leaving was not seen).
/// @param events  ascending in time
/// @param ground    how it moves, m/s; 0: over ground
/// @param backward  of all cycles
[[nodiscard]] std::vector<GaitCycle> find_cycles(const GaitPaths& paths,
                                                 std::span<const data::GaitEvent> events,
                                                 const Eigen::RowVector2d& ground, bool backward = false);

}  // namespace kinemark::analysis
