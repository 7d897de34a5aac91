// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/frame_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion::internal {
namespace {

using data::FrameStatus;

constexpr int kRetryStarts = 6;     // poses tried on a frame whose cost jumps
constexpr double kSameCost = 1e-6;  // of the cost: a pose that is better by less is as good
constexpr double kSameCost_m2 = 1e-12;
constexpr double kMuchWorse = 2.0;  // times the cost: for a pose that goes on from its neighbour's
constexpr double kSamePose = 1e-4;  // rad or m
constexpr double kFarPose = 0.5;    // rad or m: no body moves so far in a frame

}  // namespace

FrameWalk::FrameWalk(const Problem& problem, const IkOptions& options, const Progress& progress)
    : problem_(problem),
      options_(options),
      progress_(progress),
      solver_(problem, options),
      y_(3, problem.model.marker_count()),
      weight_(problem.model.marker_count()) {
  x_ = before_ = retry_ = problem.model.default_state();
  move_.setZero(problem.model.speed_count());
}

void FrameWalk::make_room(bool keep_positions, SolvedFrames& solved) const {
  const std::size_t numbers = at(3 * problem_.frames) * at(problem_.model.marker_count());
  solved.states.resize(problem_.model.state_count(), problem_.frames);
  solved.marker_error.assign(numbers, kNaN);
  solved.status.assign(at(problem_.frames), FrameStatus::no_markers);
  solved.cost.assign(at(problem_.frames), 0.0);
  solved.loop_gap_m.assign(at(problem_.frames), 0.0);
  if (keep_positions) solved.positions.assign(numbers, std::numeric_limits<float>::quiet_NaN());
}

void FrameWalk::take(const data::Trajectories& markers, const Eigen::MatrixXd& states,
                     const Array<data::FrameStatus>& status, SolvedFrames& solved) {
  make_room(true, solved);
  solved.status = status;
  for (std::int64_t f = 0; f < problem_.frames; ++f) put(markers, f, states.col(f), solved);
}

bool FrameWalk::run(const data::Trajectories& markers, bool keep_positions, SolvedFrames& solved) {
  make_room(keep_positions, solved);
  solved.first = find_first(markers);
  problem_.observe(markers, solved.first, y_, weight_);
  // The recording may begin anywhere relative to the default pose: several starts, the cheapest wins.
  find_start(problem_, options_, solver_, y_, weight_, solved.first, options_.starts, x_);
  const Eigen::VectorXd start = x_;
  if (!walk(markers, solved.first, problem_.frames, 1, solved)) return false;
  x_ = start;
  if (!walk(markers, solved.first - 1, -1, -1, solved)) return false;
  solved.iterations = solver_.iterations();
  return true;
}

/// First frame in which at least 95 % as many markers are seen as in the best frame.
std::int64_t FrameWalk::find_first(const data::Trajectories& markers) const {
  std::vector<int> seen(at(problem_.frames), 0);
  for (std::int64_t f = 0; f < problem_.frames; ++f)
    for (const int m : problem_.data_marker) seen[at(f)] += markers.present(problem_.first_frame + f, m);
  const int best = *std::max_element(seen.begin(), seen.end());
  return std::find_if(seen.begin(), seen.end(), [&](int n) { return 20 * n >= 19 * best; }) - seen.begin();
}

bool FrameWalk::walk(const data::Trajectories& markers, std::int64_t first, std::int64_t end, int direction,
                     SolvedFrames& solved) {
  last_seen_.assign(at(weight_.size()), -1);
  int steady = 0;  // frames in a row with all markers: then the pose is extrapolated
  double usual_cost = -1.0;
  for (std::int64_t f = first; f != end; f += direction) {
    ++done_;
    if (progress_ && done_ % 1000 == 0 && !progress_(done_, problem_.frames)) return false;
    problem_.observe(markers, f, y_, weight_);
    const auto visible = (weight_.array() > 0.0).count();
    if (visible == 0) {
      problem_.prescribe(f, x_);
      solved.states.col(f) = x_;
      steady = 0;
      continue;
    }
    const bool all = visible == weight_.size();
    const Eigen::VectorXd& last = x_;
    if (all && steady >= 2) {
      model::difference(problem_.model, before_, last, move_);
      before_ = last;
      model::integrate(problem_.model, x_, move_);
    } else {
      before_ = last;
    }
    steady = all ? steady + 1 : 0;
    auto outcome = solver_.solve(y_, weight_, f, x_);
    // A jump in cost may be a lost pose: try again from the neighbour laid over the markers, keep the
    // better.
    if (!outcome.converged || (usual_cost >= 0.0 && outcome.cost > 9.0 * usual_cost + 1e-4)) {
      retry_ = before_;
      const auto second = find_start(problem_, options_, solver_, y_, weight_, f,
                                     std::min(options_.starts, kRetryStarts), retry_);
      if (second.cost < 0.98 * outcome.cost) {
        x_ = retry_;
        outcome = second;
      }
      steady = 0;
      solver_.square_cost(y_, weight_, f, x_);  // residuals of the pose that was kept
    }
    compare_with_before_gap(f, direction, solved, outcome);
    unwind(before_, f);
    usual_cost = usual_cost < 0.0 ? outcome.cost : 0.95 * usual_cost + 0.05 * outcome.cost;
    store(f, outcome.converged, solved);
  }
  return true;
}

void FrameWalk::compare_with_before_gap(std::int64_t f, int direction, const SolvedFrames& solved,
                                        FrameSolver::Outcome& outcome) {
  std::int64_t before = -1;  // the oldest frame that saw a marker which comes back now
  for (Eigen::Index m = 0; m < weight_.size(); ++m) {
    if (weight_[m] == 0.0) continue;
    auto& last = last_seen_[at(m)];
    if (last >= 0 && last != f - direction && (before < 0 || (last - before) * direction < 0)) before = last;
    last = f;
  }
  if (before < 0) return;
  retry_ = solved.states.col(before);
  const Eigen::VectorXd start = retry_;
  const auto second = solver_.solve(y_, weight_, f, retry_);
  const double margin = kSameCost * outcome.cost + kSameCost_m2;
  bool take = second.converged && second.cost < outcome.cost - margin;
  if (second.converged && !take && second.cost <= outcome.cost + margin) {
    model::difference(problem_.model, start, retry_, move_);
    const double way = move_.norm();
    model::difference(problem_.model, start, x_, move_);
    take = way < move_.norm() - kSamePose;
  }
  if (take) {
    x_ = retry_;
    outcome = second;
  }
  solver_.square_cost(y_, weight_, f, x_);
}

// A hinge that a bad sample had turned comes back the shorter way round, which may end a whole turn away.
void FrameWalk::unwind(const Eigen::VectorXd& near, std::int64_t f) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (const auto& c : problem_.model.coordinates()) {
    if (c.speed_idx < 0) continue;
    const double turns = std::round((x_[c.state_idx] - near[c.state_idx]) / kTurn);
    if (turns == 0.0) continue;
    const double wound = x_[c.state_idx], unwound = wound - turns * kTurn;
    if (unwound < problem_.lower[c.speed_idx] || unwound > problem_.upper[c.speed_idx]) continue;
    const double cost = solver_.square_cost(y_, weight_, f, x_);
    x_[c.state_idx] = unwound;
    // Not every coordinate is a hinge: the pose must stay as it is.
    if (solver_.square_cost(y_, weight_, f, x_) > (1.0 + kSameCost) * cost + kSameCost_m2) {
      x_[c.state_idx] = wound;
      solver_.square_cost(y_, weight_, f, x_);
    }
  }
}

double FrameWalk::marker_cost() const {
  double sum = 0.0;
  for (Eigen::Index m = 0; m < weight_.size(); ++m)
    sum += weight_[m] * solver_.residual().col(m).squaredNorm();
  return sum / weight_.sum();
}

void FrameWalk::store(std::int64_t f, bool converged, SolvedFrames& solved) {
  const auto& model = problem_.model;
  const auto& w = solver_.workspace();
  const auto M = weight_.size();
  solved.states.col(f) = x_;
  for (Eigen::Index m = 0; m < M; ++m) {
    const auto i = at((f * M + m) * 3);
    const Eigen::Vector3d error =
        weight_[m] > 0.0 ? Eigen::Vector3d(solver_.residual().col(m)) : Eigen::Vector3d::Constant(kNaN);
    std::copy_n(error.data(), 3, solved.marker_error.data() + i);
    if (!solved.positions.empty()) {
      const auto& marker = model.markers()[at(m)];
      const Eigen::Vector3d position =
          marker.body < 0
              ? Eigen::Vector3d(y_.col(m))
              : Eigen::Vector3d(marker.x_in_body + w.rotation[at(marker.body)].transpose() * error);
      for (int axis = 0; axis < 3; ++axis)
        solved.positions[i + at(axis)] =
            weight_[m] > 0.0 ? static_cast<float>(position[axis]) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  const bool seen = (weight_.array() > 0.0).any();
  solved.status[at(f)] = !seen       ? FrameStatus::no_markers
                         : converged ? FrameStatus::converged
                                     : FrameStatus::not_converged;
  solved.loop_gap_m[at(f)] = seen ? solver_.loop_gap() : 0.0;
  solved.cost[at(f)] = seen ? marker_cost() : 0.0;
}

void FrameWalk::put(const data::Trajectories& markers, std::int64_t f, const Eigen::VectorXd& state,
                    SolvedFrames& solved) {
  problem_.observe(markers, f, y_, weight_);
  x_ = state;
  solver_.square_cost(y_, weight_, f, x_);
  store(f, solved.status[at(f)] == FrameStatus::converged, solved);
}

void FrameWalk::solve_again(const data::Trajectories& markers, const std::vector<std::uint8_t>& concerned,
                            SolvedFrames& solved) {
  const std::int64_t F = problem_.frames;
  if (concerned[at(solved.first)]) start_again(markers, concerned, solved);
  for (std::int64_t from = 0; from < F; ++from) {
    if (!concerned[at(from)]) continue;
    std::int64_t to = from;
    while (to + 1 < F && concerned[at(to + 1)]) ++to;
    // As the recording was walked over: away from the frame that was solved first.
    const bool holds_first = from <= solved.first && solved.first <= to;
    if (holds_first) {
      const Eigen::VectorXd first = solved.states.col(solved.first);
      solve_stretch(markers, solved.first, to, first, solved);
      solve_stretch(markers, solved.first, from, first, solved);
    } else if (from > solved.first) {
      solve_stretch(markers, from, to, solved.states.col(from - 1), solved);
    } else {
      solve_stretch(markers, to, from, solved.states.col(to + 1), solved);
    }
    if (to >= solved.first) follow(markers, to, 1, solved);
    if (from <= solved.first) follow(markers, from, -1, solved);
    from = to;
  }
  solved.iterations = solver_.iterations();
}

void FrameWalk::start_again(const data::Trajectories& markers, const std::vector<std::uint8_t>& concerned,
                            SolvedFrames& solved) {
  solved.first = find_first(markers);
  const std::int64_t f = solved.first;
  problem_.observe(markers, f, y_, weight_);
  if (!(weight_.array() > 0.0).any()) return;
  x_ = problem_.model.default_state();
  const auto outcome = find_start(problem_, options_, solver_, y_, weight_, f, options_.starts, x_);
  solver_.square_cost(y_, weight_, f, x_);
  model::difference(problem_.model, x_, solved.states.col(f), move_);
  const bool as_good = marker_cost() <= (1.0 + kSameCost) * solved.cost[at(f)] + kSameCost_m2;
  if (!concerned[at(f)] && (!as_good || move_.cwiseAbs().maxCoeff() < kSamePose)) return;
  store(f, outcome.converged, solved);
  for (const int direction : {1, -1}) follow(markers, f, direction, solved);
}

void FrameWalk::solve_stretch(const data::Trajectories& markers, std::int64_t from, std::int64_t to,
                              const Eigen::VectorXd& start, SolvedFrames& solved) {
  const int direction = to >= from ? 1 : -1;
  Eigen::VectorXd near = start;
  for (std::int64_t f = from; f != to + direction; f += direction) {
    problem_.observe(markers, f, y_, weight_);
    if (!(weight_.array() > 0.0).any()) {
      x_ = near;
      problem_.prescribe(f, x_);
      store(f, false, solved);
      continue;
    }
    x_ = near;
    auto outcome = solver_.solve(y_, weight_, f, x_);
    if (!outcome.converged) {
      retry_ = near;
      const auto second = find_start(problem_, options_, solver_, y_, weight_, f, kRetryStarts, retry_);
      if (second.cost < (1.0 - kSameCost) * outcome.cost) {
        x_ = retry_;
        outcome = second;
      }
    }
    unwind(near, f);
    solver_.square_cost(y_, weight_, f, x_);
    store(f, outcome.converged, solved);
    near = x_;
  }
}

void FrameWalk::follow(const data::Trajectories& markers, std::int64_t from, int direction,
                       SolvedFrames& solved) {
  for (std::int64_t f = from + direction; f >= 0 && f < problem_.frames; f += direction) {
    problem_.observe(markers, f, y_, weight_);
    if (!(weight_.array() > 0.0).any()) {
      solved.states.col(f) = solved.states.col(f - direction);
      problem_.prescribe(f, solved.states.col(f));
      continue;
    }
    x_ = solved.states.col(f - direction);
    const auto outcome = solver_.solve(y_, weight_, f, x_);
    model::difference(problem_.model, x_, solved.states.col(f), move_);
    if (move_.cwiseAbs().maxCoeff() < kSamePose) return;
    solver_.square_cost(y_, weight_, f, x_);
    if (!(marker_cost() <= kMuchWorse * solved.cost[at(f)] + kSameCost_m2)) return;
    store(f, outcome.converged, solved);
  }
}

void FrameWalk::mend(const data::Trajectories& markers, SolvedFrames& solved) {
  for (const int direction : {1, -1})
    for (std::int64_t f = solved.first + direction; f >= 0 && f < problem_.frames; f += direction) {
      model::difference(problem_.model, solved.states.col(f - direction), solved.states.col(f), move_);
      if (move_.cwiseAbs().maxCoeff() > kFarPose) follow(markers, f - direction, direction, solved);
    }
}

void FrameWalk::solve_filled(const data::Trajectories& kept, const data::Trajectories& filled,
                             const std::vector<std::uint8_t>& concerned, SolvedFrames& solved) {
  for (std::int64_t f = 0; f < problem_.frames; ++f) {
    if (!concerned[at(f)]) continue;
    problem_.observe(filled, f, y_, weight_);
    if (!(weight_.array() > 0.0).any()) continue;
    x_ = solved.states.col(f);
    const auto outcome = solver_.solve(y_, weight_, f, x_);
    solver_.square_cost(y_, weight_, f, x_);
    problem_.observe(kept, f, y_, weight_);
    store(f, outcome.converged, solved);
  }
}

}  // namespace kinemark::motion::internal
