// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

/// rad or m: settling stops where a step gains less than 1e-10 of the cost, and a nearly undetermined
/// coordinate is then not yet at its best. Part of every bound on a settled body's error.
inline constexpr double kSettled = 1e-4;

/// Noise of the goals: from the part removed by the filter, and from the residuals of the markers of each
/// segment; the larger of both. A given noise is used as it is.
[[nodiscard]] MarkerVariances goal_noise(const Plan& plan, const data::Trajectories& markers,
                                         const Track& track, const GoalFilter& filter,
                                         const TrackOptions& options);

/// q_sd, q_bound, goal_bound, determined, rank and status of all frames. Any number of threads gives the same
/// bits.
void add_error_bars(const Plan& plan, const Track& track, const MarkerVariances& noise, int threads,
                    TrackResult& result);

}  // namespace kinemark::motion::internal
