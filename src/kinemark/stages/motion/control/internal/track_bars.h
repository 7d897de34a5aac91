// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

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
