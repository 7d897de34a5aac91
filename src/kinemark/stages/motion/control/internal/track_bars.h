// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/motion/control/internal/filter_bars.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

/// rad or m: settling stops where a step gains less than 1e-10 of the cost, and a nearly undetermined
/// coordinate is then not yet at its best. Part of every bound on a settled body's error.
inline constexpr double kSettled = 1e-4;

/// Noise of the goals: from the white noise of the samples, and from the residuals of the markers of each
/// segment; the larger of both. A given noise is used as it is.
[[nodiscard]] MarkerVariances goal_noise(const Plan& plan, const Track& track, const GoalFilter& filter,
                                         const TrackOptions& options, const Eigen::VectorXd& white);

/// q_sd, q_bound, goal_bound, determined and rank of all frames by the noise of the goals, filter_sd 0; error
/// and variance of `rest`, where there is one. Any number of threads gives the same bits.
void add_goal_bars(const Plan& plan, const Track& track, const MarkerVariances& noise, int threads,
                   FilterRest* rest, TrackResult& result);

/// Coordinates that are not determined in most frames, and the status of frames.
void judge_determined(const Plan& plan, TrackResult& result);

/// All deviations and bounds of a recording that was tracked, and the markers' noise in result.fit.
void add_error_bars(const Plan& plan, const data::Trajectories& samples, const Track& track,
                    const GoalFilter& filter, const TrackOptions& options, TrackResult& result);

}  // namespace kinemark::motion::internal
