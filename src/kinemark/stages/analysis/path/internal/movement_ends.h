// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where a movement begins or ends, by a fit that lets it do so sharply.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/difference_smoother.h"
#include "kinemark/stages/analysis/path/stated_measure.h"

namespace kinemark::analysis::internal {

/// What is asked of one end of a movement.
struct EndQuestion {
  bool begins = false;          ///< the movement begins there, else it ends
  double near_s = kNaN;         ///< where it is thought to be, s from the first sample
  double movement_s = 0.0;      ///< how long the movement is thought to last
  double level = 0.0;           ///< speed that it crosses there, m/s
  double noise_variance = 0.0;  ///< of slow noise, as white noise would have it, m^2
  double deviations = 1.96;     ///< that intervals reach to both sides
};

/// What a fit says of an end.
struct SharpEnd {
  double time_s = kNaN;  ///< the speed crosses the level, s from the first sample
  double low_s = kNaN;   ///< of its interval
  double high_s = kNaN;  ///< of its interval
  /// Upper end of the acceleration with which it begins or stops, m/s^2; NaN where the velocity jumps.
  double acceleration = kNaN;
  bool velocity_jumps = false;  ///< by four nats at least it does not begin or end with a velocity of 0
};

/// Positions about an end of a movement are a place, where the point rests, and beyond some instant powers
/// of the time from there: from the second to the fourth, so that the acceleration may jump, or, where that
/// is likelier by four nats and the rate is 80 Hz or more, from the first to the third. Of a movement that
/// ends smoothly the lowest power has next to nothing. Least squares over 0.25 s of movement (at most half of
/// it; 0.15 s where these do not fit) and 0.12 s of rest, the instant by its profile; intervals by the
/// profile as well. Next to unbiased for smooth and for sharp ends, where a smoother rounds sharp ones.
/// @param x  n x 3, m
/// @return   nothing where too few samples were seen, where the fit misses them by more than noise (the point
///           does not rest, or moves in other ways), or where the speed does not cross the level
/// Cost: some 150 fits of 5 columns to the samples about the end.
[[nodiscard]] std::optional<SharpEnd> fit_sharp_end(const math::SeriesMatrix& x,
                                                    const std::vector<bool>& seen, double rate_hz,
                                                    const EndQuestion& question);

/// Both ends of a movement by fits, and what measures that rest on them would be.
struct MovementEnds {
  std::optional<SharpEnd> onset;  ///< nothing where no fit describes it
  std::optional<SharpEnd> end;    ///< likewise
  double first_s = 0.0;           ///< of the first sample, on the recording's clock
  double smooth_onset_s = kNaN;   ///< of the smoothed path, s from the first sample
  double smooth_end_s = kNaN;     ///< likewise

  /// The measure of that name with these ends in place of those of the smoothed path; all NaN where it has
  /// nothing to do with them.
  /// @param smooth  its value of the smoothed path
  [[nodiscard]] SharpValue value_of(std::string_view id, double smooth) const;
};

}  // namespace kinemark::analysis::internal
