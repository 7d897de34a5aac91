// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Defects that recorders and exporters leave in marker streams: detection, evidence and, on request,
// rejection.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory {

enum class Defect : std::uint8_t {
  zero,              ///< exactly (0, 0, 0): written by exporters for "not seen"
  stuck,             ///< the last value held while marker and neighbours move
  duplicated_frame,  ///< all markers repeat the frame before
  clock_jump,        ///< frames missing or repeated in time
  unit_slip,         ///< a thousand times too large or too small
  spike,             ///< one to three samples away from a path that goes on undisturbed
  swap_within,       ///< jumps to the path of another marker and back
  label_swap,        ///< two markers exchange their labels
};

/// "zero", "stuck", "duplicated frame", "clock jump", "unit slip", "spike", "swap within", "label swap".
[[nodiscard]] std::string_view to_string(Defect defect);

/// One defect: where, how strong the evidence is, and a sentence that says it with numbers.
struct Finding {
  Defect defect = Defect::zero;
  std::int64_t marker = -1;        ///< -1: all markers
  std::int64_t other_marker = -1;  ///< the partner of a swap, else -1
  std::int64_t first_frame = 0;    ///< both ends belong to it
  std::int64_t last_frame = 0;
  double evidence = 0.0;    ///< the deciding ratio, larger is stronger; what it is depends on the defect
  double confidence = 0.0;  ///< 0 to 1; below 0.8 a person should check
  std::string sentence;
};

/// Options of screen(): kinds of defects and thresholds.
struct ScreenOptions {
  bool zeros = true, stuck = true, duplicated_frames = true, clock_jumps = true, unit_slips = true,
       spikes = true, swaps = true;
  double min_spike_m = 0.01;    ///< > 0, smaller ones are left to the filter
  double min_jump_m = 0.03;     ///< > 0, swaps across less cannot be distinguished from motion
  double min_stuck_s = 0.1;     ///< > 0; and never below 8 frames
  double min_confidence = 0.5;  ///< 0 to 1, findings below are not reported

  [[nodiscard]] Status check() const;
};

/// Search for defects. Nothing is altered.
///
/// @param frame_time_s  Recorded time of each frame, s (F), or empty. Not a number, going back or standing
/// still: a
///                      clock jump. Without it only gaps of the clock that show as a simultaneous leap of all
///                      markers are seen.
/// @return              By marker and frame; those of all markers first.
/// Frames, markers and their confidence: docs/stages/clean-screening.md. Swaps of markers that pass one
/// another closer than min_jump_m, and any defect that lasts the whole recording except zeros and unit slips,
/// cannot be seen. Fails when the trajectories are invalid, the options do not hold or frame_time_s has
/// another length. O(F M), swaps O(F M + jumps M).
[[nodiscard]] Result<std::vector<Finding>> screen(const data::Trajectories& trajectories,
                                                  const ScreenOptions& options = {},
                                                  std::span<const double> frame_time_s = {});

/// The repair: samples of all findings of at least that confidence get the state `rejected` and lose their
/// coordinates; label swaps lose both markers. Clock jumps have no wrong samples and reject nothing.
/// Code::bad_input when a finding does not fit the trajectories.
[[nodiscard]] Result<data::Trajectories> reject_findings(const data::Trajectories& trajectories,
                                                         std::span<const Finding> findings,
                                                         double min_confidence = 0.8);

}  // namespace kinemark::trajectory
