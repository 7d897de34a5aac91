// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/best_fit.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/internal/held_speeds.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {
namespace {

constexpr int kMostSteps = 30;
constexpr double kShrinks = 0.5;   // of the step before, at least
constexpr double kLongest = 0.3;   // rad or m, of one step
constexpr double kArrived = 1e-7;  // rad or m
constexpr double kOnLimit = 1e-9;  // rad or m

}  // namespace

BestFit::BestFit(const Problem& problem) : problem_(problem), w_(problem.model) {
  residual_.setZero(3, problem.model.marker_count());
  way_.setZero(problem.model.coordinate_count());
  left_ = way_;
}

void BestFit::visit(const GoalValues& goal) {
  const auto& model = problem_.model;
  model::kinematics(model, w_, x_);
  residual_ = goal.x - w_.marker;
  model::clear_forces(w_);
  model::add_marker_forces(model, w_, goal.weight, residual_);
  model::project_forces(model, w_, step_);
}

bool BestFit::hold_pressed() {
  held_before_.swap(held_);
  held_ = problem_.fixed_speed;
  for (const auto& c : problem_.model.coordinates()) {
    const int k = c.speed_idx;
    if (k < 0) continue;
    const double q = x_[c.state_idx];
    if ((q <= problem_.lower[k] + kOnLimit && step_[k] < 0.0) ||
        (q >= problem_.upper[k] - kOnLimit && step_[k] > 0.0))
      held_[at(k)] = 1;
  }
  for (Eigen::Index k = 0; k < step_.size(); ++k)
    if (held_[at(k)] != 0) step_[k] = 0.0;
  return held_ != held_before_;
}

bool BestFit::factorise() {
  held_H_ = H_;
  hold_speeds(held_H_, held_);
  llt_.compute(held_H_);
  return llt_.info() == Eigen::Success;
}

void BestFit::clamp() {
  for (const auto& c : problem_.model.coordinates()) {
    if (c.speed_idx < 0 || held_[at(c.speed_idx)] != 0) continue;
    const double q = x_[c.state_idx], low = std::min(problem_.lower[c.speed_idx] - q, 0.0),
                 high = std::max(problem_.upper[c.speed_idx] - q, 0.0);
    step_[c.speed_idx] = std::clamp(step_[c.speed_idx], low, high);
  }
}

bool BestFit::find(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal) {
  const auto& model = problem_.model;
  x_ = x;
  held_.clear();
  double length = 0.0;
  bool slow = true;
  for (int i = 0; i < kMostSteps; ++i) {
    visit(goal);
    if (slow) {
      model::marker_normal_matrix(model, w_, goal.weight, H_);
      model::subtract_force_curvature(model, w_, H_);
    }
    if ((hold_pressed() || slow) && !factorise()) {
      // The residuals make H indefinite here. J'WJ alone, the step of equation 15, leads out of such a place.
      model::marker_normal_matrix(model, w_, goal.weight, H_);
      if (!factorise()) return false;
    }
    llt_.solveInPlace(step_);
    clamp();
    if (!step_.allFinite()) return false;
    double longest = step_.cwiseAbs().maxCoeff();
    if (longest > kLongest) {
      step_ *= kLongest / longest;
      longest = kLongest;
    }
    slow = longest > kShrinks * length;
    length = longest;
    model::integrate(model, x_, step_);
    if (length <= kArrived) break;
  }
  if (length > kArrived && slow) return false;
  model::coordinate_jacobian(model, w_, q, E_);
  left_.noalias() = E_ * step_;
  model::coordinates_from_state(model, x_, q, way_);
  way_ -= q;
  return true;
}

}  // namespace kinemark::motion::internal
