// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/track_bars.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/motion/control/internal/bounds.h"
#include "kinemark/stages/motion/internal/marker_account.h"

namespace kinemark::motion::internal {
namespace {

using data::FrameStatus;

constexpr double kDeterminedShare = 0.95;  // of the frames

}  // namespace

MarkerVariances goal_noise(const Plan& plan, const Track& track, const GoalFilter& filter,
                           const TrackOptions& options, const Eigen::VectorXd& white) {
  const auto& p = plan.problem;
  const double gain = options.derivatives != nullptr ? 1.0 : filter.noise_in_goal();
  if (options.marker_noise_sd_m > 0.0)
    return {.own = gain * white,
            .common = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.model.bodies().size()))};
  MarkerVariances noise = estimate_variances(p, track.goals, track.states, options.threads);
  if (white.size() > 0) noise.own = noise.own.cwiseMax(gain * white);
  return noise;
}

void add_goal_bars(const Plan& plan, const Track& track, const MarkerVariances& noise, int threads,
                   FilterRest* rest, TrackResult& result) {
  auto& motion = result.motion;
  const auto& p = plan.problem;
  const auto n = static_cast<std::int64_t>(motion.coordinates.size());
  motion.q_sd.assign(motion.q.size(), kNaN);
  motion.q_bound.assign(motion.q.size(), kNaN);
  result.goal_error.assign(motion.q.size(), kNaN);
  result.goal_bound.assign(motion.q.size(), kNaN);
  result.filter_sd.assign(motion.q.size(), 0.0);
  motion.determined.assign(motion.q.size(), 0);
  if (rest != nullptr) rest->error.setZero(n, p.frames), rest->variance.setZero(n, p.frames);
  parallel_for(p.frames, 16, threads, [&](std::int64_t begin, std::int64_t end) {
    Bounds bounds(plan);
    GoalValues goal(p.model.marker_count());
    Eigen::Matrix3Xd taken;
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
      if (rest == nullptr || motion.status[at(f)] == FrameStatus::not_converged) continue;
      rest_of(plan, rest->samples, track, f, taken);
      rest->error.col(f) = bounds.coordinates_of(taken);
      rest->variance.col(f) = bounds.variance_of(rest->white);
      for (std::int64_t c = 0; c < n; ++c)
        if (bounds.determined()[at(c)] == 0) rest->variance(c, f) = 0.0;
    }
  });
}

void judge_determined(const Plan& plan, TrackResult& result) {
  auto& motion = result.motion;
  const auto& p = plan.problem;
  const auto n = motion.size();
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

void add_error_bars(const Plan& plan, const data::Trajectories& samples, const Track& track,
                    const GoalFilter& filter, const TrackOptions& options, TrackResult& result) {
  const bool filtered = options.derivatives == nullptr && filter.noise_in_rest() >= 1e-3;
  FilterRest rest{.samples = samples, .white = {}, .error = {}, .variance = {}};
  if (options.marker_noise_sd_m > 0.0)
    rest.white.setConstant(plan.problem.model.marker_count(),
                           options.marker_noise_sd_m * options.marker_noise_sd_m);
  else if (filtered)
    rest.white = white_noise(plan, samples, track, filter, options.threads, result.motion);
  const auto noise = goal_noise(plan, track, filter, options, rest.white);
  add_goal_bars(plan, track, noise, options.threads, filtered ? &rest : nullptr, result);
  if (filtered) add_filter_bars(rest, filter, options.cutoff_hz / plan.rate_hz, options.threads, result);
  judge_determined(plan, result);
  add_marker_noise(plan.problem.model, noise, result.fit);
}

}  // namespace kinemark::motion::internal
