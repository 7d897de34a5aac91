// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/track_bars.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/motion/control/internal/bounds.h"
#include "kinemark/stages/motion/internal/marker_account.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::int64_t kMostFrames = 300;
constexpr double kOfAll = 0.2;  // of a marker's own samples: how much that of all markers counts in it
constexpr double kLeastFreedom = 0.02;  // of all numbers: with less, changes of the pose explain everything

/// One coordinate: SD of what the filter took away, F; 0 where not determined.
VectorXd filter_sd(const VectorXd& error, const VectorXd& variance, double noise_in_goal, double cutoff) {
  VectorXd out = VectorXd::Zero(error.size());
  std::vector<double> seen;
  for (const double v : variance)
    if (v > 0.0) seen.push_back(v);
  if (seen.size() < kFewestSamples) return out;
  const double usual = math::upper_median(seen);
  const VectorXd y = error / std::sqrt(usual);
  const VectorXd weight =
      (variance.array() > 0.0).select(usual / variance.array().max(1e-6 * usual), VectorXd::Zero(y.size()));
  // Begins at the filter's own bandwidth.
  const auto nearest = nearest_curve(y, weight, std::pow(2.0 * std::numbers::pi * cutoff, 6));
  const auto curve = curve_of(y, weight, nearest.step_variance);
  for (Index f = 0; f < out.size(); ++f) {
    if (!(variance[f] > 0.0)) continue;
    // Noise of the goal is in q_sd already: only what the curve has beyond it is added.
    const double noise = std::max(0.0, curve.variance[f] - noise_in_goal * variance[f] / usual);
    // The square of what was found has that noise in it too.
    out[f] = std::sqrt(usual * std::max(curve.value[f] * curve.value[f], noise + nearest.spread[f]));
  }
  return out;
}

using data::FrameStatus;

constexpr double kDeterminedShare = 0.95;  // of the frames

}  // namespace

void rest_of(const Plan& plan, const data::Trajectories& samples, const Track& track, std::int64_t frame,
             Eigen::Matrix3Xd& rest) {
  const auto& p = plan.problem;
  rest.setZero(3, p.model.marker_count());
  for (Index m = 0; m < rest.cols(); ++m) {
    const auto column = p.data_marker[at(m)];
    if (track.weights(m, frame) > 0.0 && samples.present(p.first_frame + frame, column))
      rest.col(m) = samples.x(p.first_frame + frame, column) - track.goals.x(p.first_frame + frame, column);
  }
}

VectorXd white_noise(const Plan& plan, const data::Trajectories& samples, const Track& track,
                     const GoalFilter& filter, int threads, const data::JointMotion& motion) {
  const auto& p = plan.problem;
  const Index M = p.model.marker_count();
  const std::int64_t stride = std::max<std::int64_t>(1, (p.frames + kMostFrames - 1) / kMostFrames),
                     frames = (p.frames + stride - 1) / stride;
  MatrixXd squares = MatrixXd::Zero(M, frames), freedom = squares, all = squares, seen = squares;
  const MarkerVariances nothing{.own = VectorXd::Zero(M),
                                .common = VectorXd::Zero(static_cast<Index>(p.model.bodies().size()))};
  parallel_for(frames, 8, threads, [&](std::int64_t begin, std::int64_t end) {
    Bounds bounds(plan);
    GoalValues goal(static_cast<int>(M));
    Eigen::Matrix3Xd rest;
    VectorXd left, ways;
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t f = i * stride;
      goal.weight = (track.weights.col(f).array() >= p.weight.array()).select(track.weights.col(f), 0.0);
      for (Index m = 0; m < M; ++m)
        if (goal.weight[m] > 0.0) goal.x.col(m) = track.goals.x(p.first_frame + f, p.data_marker[at(m)]);
      const Eigen::Map<const VectorXd> q(motion.q.data() + motion.index(f, 0), motion.size());
      bounds.find(track.states.col(f), q, goal, motion.time.time_s(f), nothing);
      rest_of(plan, samples, track, f, rest);
      bounds.unexplained(rest, left, ways);
      for (Index m = 0; m < M; ++m) {
        if (!(goal.weight[m] > 0.0) || !samples.present(p.first_frame + f, p.data_marker[at(m)])) continue;
        squares(m, i) = left[m], freedom(m, i) = ways[m];
        all(m, i) = rest.col(m).squaredNorm(), seen(m, i) = 3.0;
      }
    }
  });
  if (freedom.sum() < kLeastFreedom * seen.sum()) squares = all, freedom = seen;
  const double usual = freedom.sum() > 0.0 ? squares.sum() / freedom.sum() : 0.0;
  const VectorXd counted = kOfAll * seen.rowwise().sum();
  const VectorXd share = (squares.rowwise().sum() + usual * counted).array() /
                         (freedom.rowwise().sum() + counted).array().max(1e-300);
  return share / filter.noise_in_rest();
}

void add_filter_bars(const FilterRest& rest, const GoalFilter& filter, double cutoff, int threads,
                     TrackResult& result) {
  auto& motion = result.motion;
  const std::int64_t F = motion.frames();
  parallel_for(motion.size(), 1, threads, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) {
      const VectorXd sd = filter_sd(rest.error.row(c), rest.variance.row(c), filter.noise_in_goal(), cutoff);
      for (std::int64_t f = 0; f < F; ++f) {
        const auto i = motion.index(f, c);
        result.filter_sd[i] = motion.determined[i] != 0 ? sd[f] : kNaN;
        if (motion.determined[i] == 0 || !(motion.q_sd[i] >= 0.0)) continue;
        const double lag = std::abs(result.goal_error[i]),
                     noise = std::sqrt(std::max(0.0, motion.q_sd[i] * motion.q_sd[i] - lag * lag));
        motion.q_sd[i] = std::hypot(motion.q_sd[i], sd[f]);
        motion.q_bound[i] += Bounds::kNoiseSds * (std::hypot(noise, sd[f]) - noise);
        if (motion.q_sd[i] <= Bounds::kLargestSd) continue;
        motion.determined[i] = 0;
        motion.q_sd[i] = motion.q_bound[i] = result.goal_error[i] = result.goal_bound[i] = kNaN;
        result.filter_sd[i] = kNaN;
      }
    }
  });
}

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
