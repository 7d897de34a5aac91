// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/track_bars.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/motion/control/internal/bounds.h"

namespace kinemark::motion::internal {
namespace {

using data::FrameStatus;

constexpr double kDeterminedShare = 0.95;  // of the frames

}  // namespace

MarkerVariances goal_noise(const Plan& plan, const data::Trajectories& markers, const Track& track,
                           const GoalFilter& filter, const TrackOptions& options) {
  const auto& p = plan.problem;
  const Eigen::Index M = p.model.marker_count();
  MarkerVariances noise;
  if (options.marker_noise_sd_m > 0.0) {
    const double gain = options.derivatives != nullptr ? 1.0 : filter.noise_in_goal();
    noise.own.setConstant(M, gain * options.marker_noise_sd_m * options.marker_noise_sd_m);
    noise.common.setZero(static_cast<Eigen::Index>(p.model.bodies().size()));
    return noise;
  }
  noise = estimate_variances(p, track.goals, track.states, options.threads);
  if (options.derivatives != nullptr || filter.noise_in_rest() < 1e-3) return noise;
  for (Eigen::Index m = 0; m < M; ++m) {
    double squares = 0.0;
    std::int64_t count = 0;
    for (std::int64_t f = 0; f < p.frames; ++f) {
      if (track.weights(m, f) < p.weight[m]) continue;
      const auto frame = p.first_frame + f;
      squares +=
          (markers.x(frame, p.data_marker[at(m)]) - track.goals.x(frame, p.data_marker[at(m)])).squaredNorm();
      ++count;
    }
    if (count == 0) continue;
    const double white = squares / (3.0 * static_cast<double>(count) * filter.noise_in_rest());
    noise.own[m] = std::max(noise.own[m], white * filter.noise_in_goal());
  }
  return noise;
}

void add_error_bars(const Plan& plan, const Track& track, const MarkerVariances& noise, int threads,
                    TrackResult& result) {
  auto& motion = result.motion;
  const auto& p = plan.problem;
  const auto n = static_cast<std::int64_t>(motion.coordinates.size());
  motion.q_sd.assign(motion.q.size(), kNaN);
  motion.q_bound.assign(motion.q.size(), kNaN);
  result.goal_error.assign(motion.q.size(), kNaN);
  result.goal_bound.assign(motion.q.size(), kNaN);
  motion.determined.assign(motion.q.size(), 0);
  parallel_for(p.frames, 16, threads, [&](std::int64_t begin, std::int64_t end) {
    Bounds bounds(plan);
    GoalValues goal(p.model.marker_count());
    for (std::int64_t f = begin; f < end; ++f) {
      goal.weight = track.weights.col(f);
      for (Eigen::Index m = 0; m < goal.weight.size(); ++m)
        if (goal.weight[m] > 0.0) goal.x.col(m) = track.goals.x(p.first_frame + f, p.data_marker[at(m)]);
      const Eigen::Map<const Eigen::VectorXd> q(motion.q.data() + motion.index(f, 0), n);
      bounds.find(track.states.col(f), q, goal, motion.time.time_s(f), noise);
      result.rank[at(f)] = bounds.rank();
      result.smallest_singular[at(f)] = bounds.smallest_singular();
      for (std::int64_t c = 0; c < n; ++c) {
        motion.q_sd[motion.index(f, c)] = bounds.sd()[c];
        motion.q_bound[motion.index(f, c)] = bounds.bound()[c] + (plan.settle ? kSettled : 0.0);
        result.goal_error[motion.index(f, c)] = bounds.goal_error()[c];
        result.goal_bound[motion.index(f, c)] = bounds.goal_bound()[c];
        motion.determined[motion.index(f, c)] = bounds.determined()[at(c)];
      }
    }
  });
  for (std::int64_t c = 0; c < n; ++c) {
    std::int64_t fixed = 0;
    for (std::int64_t f = 0; f < p.frames; ++f) fixed += motion.determined[motion.index(f, c)];
    if (static_cast<double>(fixed) < kDeterminedShare * static_cast<double>(p.frames))
      result.undetermined_coordinates.push_back(motion.coordinates[at(c)]);
  }
  for (std::int64_t f = 0; f < p.frames; ++f) {
    const auto* row = motion.determined.data() + motion.index(f, 0);
    auto& status = motion.status[at(f)];
    if (status != FrameStatus::converged && status != FrameStatus::underdetermined) continue;
    // The rank of a step excludes coordinates at a limit; the rank determined by the markers is reported
    // instead.
    const bool all = std::all_of(row, row + n, [](auto d) { return d != 0; });
    status = all ? FrameStatus::converged : FrameStatus::underdetermined;
  }
}

}  // namespace kinemark::motion::internal
