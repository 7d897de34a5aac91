// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/turned_poses.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kTurnSteps = 8;     // of half a turn about a line
constexpr int kSwings = 12;       // positions of a joint beyond it
constexpr double kOffTurn = 0.3;  // of a joint that does not turn about it
constexpr double kFastestTurn =
    4.0;  // rad of a coordinate for one of the turn: beyond, its axes lie together

bool within_limits(const Problem& problem, const VectorXd& state) {
  return std::ranges::all_of(problem.model.coordinates(), [&](const auto& c) {
    return c.speed_idx < 0 || (state[c.state_idx] >= problem.lower[c.speed_idx] &&
                               state[c.state_idx] <= problem.upper[c.speed_idx]);
  });
}

}  // namespace

bool TurnedPoses::turn(const UnseenTurn& unseen, const Eigen::Matrix3Xd& y, const VectorXd& information,
                       VectorXd& state) {
  y_ = &y;
  information_ = &information;
  if (!turn_half(unseen, state)) return false;
  for (const auto& c : problem_.model.coordinates())
    if (c.speed_idx >= 0)
      state[c.state_idx] =
          std::clamp(state[c.state_idx], problem_.lower[c.speed_idx], problem_.upper[c.speed_idx]);
  const auto bodies = problem_.model.bodies();
  const int first = bodies[at(unseen.body)].first_column;
  for (std::size_t b = at(unseen.body) + 1; b < bodies.size(); ++b)
    if (std::ranges::find(bodies[b].support, first) != bodies[b].support.end())
      for (int c = bodies[b].first_column; c < bodies[b].last_column; ++c) swing(c, state);
  return true;
}

bool TurnedPoses::turn_half(const UnseenTurn& unseen, VectorXd& state) {
  const auto& model = problem_.model;
  const auto& body = model.bodies()[at(unseen.body)];
  for (int k = 0; k < kTurnSteps; ++k) {
    model::kinematics(model, w_, state);
    const Vector3d along = model::point_in_world(w_, unseen.body, unseen.along) -
                           model::point_in_world(w_, unseen.body, Vector3d::Zero());
    Eigen::Matrix3Xd axes = Eigen::Matrix3Xd::Zero(3, body.last_column - body.first_column);
    for (int c = body.first_column; c < body.last_column; ++c)
      if (!problem_.fixed_speed[at(model.columns()[at(c)].speed)])
        axes.col(c - body.first_column) = w_.column[at(c)].w;
    const VectorXd rate = axes.completeOrthogonalDecomposition().solve(along);
    if ((axes * rate - along).norm() > kOffTurn || rate.cwiseAbs().maxCoeff() > kFastestTurn) return false;
    move_.setZero(model.speed_count());
    for (int c = body.first_column; c < body.last_column; ++c)
      move_[model.columns()[at(c)].speed] += std::numbers::pi / kTurnSteps * rate[c - body.first_column];
    model::integrate(model, state, move_);
  }
  return true;
}

/// Turn one axis to where the markers fit best.
void TurnedPoses::swing(int column, VectorXd& state) {
  const auto& model = problem_.model;
  const int speed = model.columns()[at(column)].speed;
  model::kinematics(model, w_, state);
  if (problem_.fixed_speed[at(speed)] || !(w_.column[at(column)].w.norm() > 0.5)) return;
  double least = squares();
  VectorXd best = state;
  for (int k = 1; k < kSwings; ++k) {
    tried_ = state;
    move_.setZero(model.speed_count());
    move_[speed] = std::remainder(2.0 * std::numbers::pi * k / kSwings, 2.0 * std::numbers::pi);
    model::integrate(model, tried_, move_);
    if (!within_limits(problem_, tried_)) continue;
    model::kinematics(model, w_, tried_);
    if (const double here = squares(); here < least) {
      least = here;
      best = tried_;
    }
  }
  state = best;
}

/// Chi-square of the pose that w_ has.
double TurnedPoses::squares() const {
  double sum = 0.0;
  for (Eigen::Index m = 0; m < information_->size(); ++m)
    if ((*information_)[m] > 0.0) sum += (*information_)[m] * (y_->col(m) - w_.marker.col(m)).squaredNorm();
  return sum;
}

}  // namespace kinemark::motion::internal
