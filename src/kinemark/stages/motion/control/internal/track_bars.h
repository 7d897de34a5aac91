// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the filter of the goals takes away from a movement, as an error of the coordinates.
//
// Samples minus goals, turned into coordinates frame by frame, are the movement that the filter took away and
// the white noise that it took away. The curve nearest to the first (coordinate_smoother.h) is found by the
// second, which is known: no change of the pose explains most of it.
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

/// Samples minus goals of all frames.
struct FilterRest {
  const data::Trajectories& samples;
  Eigen::VectorXd white;     ///< M, variance of the samples' white noise per axis, m^2
  Eigen::MatrixXd error;     ///< n x F, as coordinates, to first order
  Eigen::MatrixXd variance;  ///< n x F, of it by white noise of the samples; 0: not determined
};

/// Samples minus goals of one frame, 3 x M; 0 where a marker is no goal or has no sample.
void rest_of(const Plan& plan, const data::Trajectories& samples, const Track& track, std::int64_t frame,
             Eigen::Matrix3Xd& rest);

/// Variance of the samples' white noise (M, per axis, m^2): what the filter took away, without what a change
/// of the pose explains. Where hardly anything is left beyond that, all of it. Of every k-th frame, 300 at
/// most.
[[nodiscard]] Eigen::VectorXd white_noise(const Plan& plan, const data::Trajectories& samples,
                                          const Track& track, const GoalFilter& filter, int threads,
                                          const data::JointMotion& motion);

/// Widens q_sd and q_bound by what the filter took away from the movement, which filter_sd becomes. What gets
/// wider than a deviation may be is not determined any more.
/// @param cutoff  of the filter, in units of the rate
void add_filter_bars(const FilterRest& rest, const GoalFilter& filter, double cutoff, int threads,
                     TrackResult& result);

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
