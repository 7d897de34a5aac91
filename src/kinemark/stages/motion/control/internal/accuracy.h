// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cut-off, step and gains for a wanted accuracy. Noise and lost movement are turned into angles by equations
// 14 and 15; the cut-off is the one at which both together are least. Gains filter nothing as long as the
// goals' rates are fed forward: they follow from the step, and the step from what it may cost.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/stages/motion/control/internal/followed_run.h"

namespace kinemark::motion::internal {

/// Options of the run that shows noise and movement: 8 Hz where the rate allows it, steps of 1/240 s.
[[nodiscard]] TrackOptions pilot_options(double rate_hz, const TrackOptions& options);

/// The choice for options.accuracy_rad. Fails in one sentence where it cannot be had, with what would do, or
/// where the samples were smoothed before, so that nobody knows.
///
/// @param plan   levels as they will be followed: of their matrices
/// @param pilot  a run with pilot_options()
[[nodiscard]] Result<AccuracyChoice> choose_by_accuracy(const Plan& plan, const JudgedRun& pilot,
                                                        const data::Trajectories& markers,
                                                        const GoalFilter& pilot_filter,
                                                        const TrackOptions& options);

}  // namespace kinemark::motion::internal
