// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Defects that recorders and exporters leave in marker streams: detection, evidence and, on request,
// rejection.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory {

/// Options of screen(): kinds of defects and thresholds.
struct ScreenOptions {
  /// which defects are looked for
  bool zeros = true, stuck = true, duplicated_frames = true, clock_jumps = true, unit_slips = true,
       spikes = true, swaps = true;
  double min_spike_m = 0.01;    ///< > 0, smaller ones are left to the filter
  double min_jump_m = 0.03;     ///< > 0, swaps across less cannot be distinguished from motion
  double min_stuck_s = 0.1;     ///< > 0; and never below 8 frames
  double min_confidence = 0.5;  ///< 0 to 1, defects below are not reported
  /// What else tells which side of an exchange is right. Asked of the trajectories with all exchanges undone
  /// and of the indices of two markers: 1: the two have their own labels, -1: each has the other's
  /// throughout, 0: not known. Empty: distances and the number of frames alone tell.
  std::function<int(const data::Trajectories&, std::int64_t, std::int64_t)> side = {};

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// Search for defects. Nothing is altered.
///
/// @param frame_time_s  Recorded time of each frame, s (F), or empty. Not a number, going back or standing
/// still: a
///                      clock jump. Without it only gaps of the clock that show as a simultaneous leap of all
///                      markers are seen.
/// @return              By marker and frame; those of all markers first. Each tells its evidence in words.
/// Frames, markers and their confidence: docs/stages/clean-screening.md. Swaps of markers that pass one
/// another closer than min_jump_m, and any defect that lasts the whole recording except zeros and unit slips,
/// cannot be seen. Fails when the trajectories are invalid, the options do not hold or frame_time_s has
/// another length. O(F M), swaps O(F M + jumps M).
[[nodiscard]] Result<std::vector<data::Finding>> screen(const data::Trajectories& trajectories,
                                                        const ScreenOptions& options = {},
                                                        std::span<const double> frame_time_s = {});

/// The repair: samples of all defects of at least that confidence get the state `rejected` and lose their
/// coordinates; label swaps lose both markers. Clock jumps have no wrong samples and reject nothing.
/// Code::bad_input when a defect does not fit the trajectories.
[[nodiscard]] Result<data::Trajectories> reject_defects(const data::Trajectories& trajectories,
                                                        std::span<const data::Finding> defects,
                                                        double min_confidence = 0.8);

}  // namespace kinemark::trajectory
