// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/controller.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

// Singular values (kg^-1/2) above which a single level needs no singular vectors: it fixes all directions.
constexpr double kFullRank = 0.03;
constexpr double kJoinedDamping = 0.03;  // of all levels in one sum of squares
constexpr double kStartDamping = 0.01;   // of the speeds at the start
constexpr int kMostHolds = 8;            // rounds of adding coordinates that rest at a limit
constexpr PriorityDamping kLoops{.damping = 0.0, .truncation = 1e-6};

}  // namespace

Controller::Controller(const Plan& plan)
    : plan_(plan),
      model_(plan.problem.model),
      w_(model_),
      solver_(model_.speed_count()),
      one_level_(plan.levels.size() == 1 && model_.point_constraints().empty()) {
  const int n = model_.speed_count(), M = model_.marker_count();
  const auto K = 3 * static_cast<Eigen::Index>(model_.point_constraints().size());
  x_ = model_.default_state();
  kept_x_ = x_;
  for (auto* v :
       {&v_, &a_, &now_a_, &wished_, &normal_force_, &held_a_, &move_, &kept_v_, &kept_a_, &outside_force_})
    v->setZero(n);
  bias_.setZero(3 * M);
  weight_.setZero(M);
  for (auto* m : {&command_, &marker_begun_, &marker_ended_}) m->setZero(3, M);
  for (auto* m : {&M_, &H_}) m->setZero(n, n);
  J_.setZero(3 * M, n);
  loop_J_.setZero(K, n);
  loop_gap_.setZero(K);
  loop_r_.setZero(K);
  llt_ = Eigen::LLT<Eigen::MatrixXd>(n);
  for (const auto& level : plan.levels) {
    Gathered g;
    g.J.setZero(level.rows(), n);
    g.r.setZero(level.rows());
    g.tasks.resize(level.tasks.size());
    gathered_.push_back(std::move(g));
  }
  held_ = plan.problem.fixed_speed;
}

void Controller::start(const Eigen::VectorXd& x, const GoalValues& goal, double time_s) {
  x_ = x;
  v_.setZero();
  model::kinematics(model_, w_, x_);
  model::velocities(model_, w_, v_);
  weight_ = goal.weight.cwiseProduct(plan_.in_levels);
  model::marker_normal_matrix(model_, w_, weight_, H_);
  model::clear_forces(w_);
  model::add_marker_forces(model_, w_, weight_, goal.v);
  model::project_forces(model_, w_, normal_force_);
  for (std::size_t i = 0; i < plan_.levels.size(); ++i)
    for (std::size_t t = 0; t < plan_.levels[i].tasks.size(); ++t) {
      auto& rows = gathered_[i].tasks[t];
      plan_.levels[i].evaluate(t, plan_.problem, w_, goal, time_s, rows);
      H_ += rows.jacobian.transpose() * rows.weight.asDiagonal() * rows.jacobian;
      normal_force_ += rows.jacobian.transpose() * rows.weight.cwiseProduct(rows.goal_velocity);
    }
  model::mass_matrix(model_, w_, M_);
  H_ += kStartDamping * kStartDamping * M_;
  hold_speeds(H_, plan_.problem.fixed_speed);
  for (Eigen::Index k = 0; k < v_.size(); ++k)
    if (plan_.problem.fixed_speed[at(k)] != 0) normal_force_[k] = 0.0;
  llt_.compute(H_);
  if (plan_.feed_forward && llt_.info() == Eigen::Success) v_ = llt_.solve(normal_force_);
  if (!v_.allFinite()) v_.setZero();
  a_.setZero();
  now_a_.setZero();
  forget_step();
}

// Over a step the acceleration is constant, that of the goals is not. With a jerk j the speed ends h (h/2 -
// c) j off, and the position h^2 (h/6 - c/2) j; the law keeps what is left of both at rest where their sum,
// with kd and kp, vanishes.
double Controller::later_s(double h) const {
  if (!plan_.feed_forward) return 0.0;
  return std::max(0.0, h * (0.5 - plan_.kp * h / (3.0 * plan_.kd)));
}

void Controller::find_marker_accelerations(const Eigen::VectorXd& a, Eigen::Matrix3Xd& out) {
  // Rates of positions by `a` in place of the speeds are the rows J a.
  model::velocities(model_, w_, a);
  for (Eigen::Index m = 0; m < out.cols(); ++m)
    out.col(m) = model::point_velocity(w_, model_.markers()[at(m)].body, w_.marker.col(m));
  model::velocities(model_, w_, v_);
  for (Eigen::Index m = 0; m < out.cols(); ++m)
    out.col(m) += model::point_bias_acceleration(w_, model_.markers()[at(m)].body, w_.marker.col(m));
}

void Controller::find_commands(const GoalValues& goal, double time_s,
                               const Eigen::Matrix3Xd& goal_acceleration, double later_s) {
  model::marker_bias_acceleration(model_, w_, bias_);
  // J'q' and J q'' go on changing as they did over the step before.
  const double on = step_s_ > 0.0 ? later_s / step_s_ : 0.0;
  const double feed = plan_.feed_forward ? 1.0 : 0.0;
  for (Eigen::Index m = 0; m < goal.weight.size(); ++m) {
    if (goal.weight[m] == 0.0) {
      command_.col(m).setZero();
      continue;
    }
    const Eigen::Vector3d position = w_.marker.col(m);
    const Eigen::Vector3d velocity = model::point_velocity(w_, model_.markers()[at(m)].body, position);
    command_.col(m) = feed * goal_acceleration.col(m) + plan_.kd * (feed * goal.v.col(m) - velocity) +
                      plan_.kp * (goal.x.col(m) - position) - bias_.segment<3>(3 * m) -
                      on * (marker_ended_.col(m) - marker_begun_.col(m));
  }
  for (std::size_t i = 0; i < plan_.levels.size(); ++i)
    for (std::size_t t = 0; t < plan_.levels[i].tasks.size(); ++t) {
      auto& rows = gathered_[i].tasks[t];
      plan_.levels[i].evaluate(t, plan_.problem, w_, goal, time_s, rows);
      // From here on `error` holds the right-hand side of the rows.
      rows.error *= plan_.kp;
      rows.error +=
          plan_.kd * (feed * rows.goal_velocity - rows.velocity) + feed * rows.goal_acceleration - rows.bias;
    }
}

void Controller::gather_level(const Plan::Level& level, std::size_t index, const Eigen::VectorXd& weight) {
  auto& g = gathered_[index];
  Eigen::Index row = 0;
  for (const int m : level.markers) {
    const double scale = std::sqrt(weight[m]);
    g.J.middleRows<3>(row) = scale * J_.middleRows<3>(3 * static_cast<Eigen::Index>(m));
    g.r.segment<3>(row) = scale * command_.col(m);
    row += 3;
  }
  for (const auto& task : g.tasks)
    for (Eigen::Index i = 0; i < task.error.size(); ++i, ++row) {
      const double scale = std::sqrt(task.weight[i]);
      g.J.row(row) = scale * task.jacobian.row(i);
      g.r[row] = scale * task.error[i];
    }
}

void Controller::close_loops() {
  if (model_.point_constraints().empty()) return;
  model::point_constraint_gaps(model_, w_, loop_gap_);
  model::point_constraint_jacobian(model_, w_, loop_J_);
  loop_r_.noalias() = loop_J_ * v_;
  loop_r_ *= -plan_.kd;
  loop_r_ -= plan_.kp * loop_gap_;
  Eigen::Index row = 0;
  for (const auto& c : model_.point_constraints()) {
    const Eigen::Vector3d a = model::point_in_world(w_, c.body_a, c.point_in_a);
    const Eigen::Vector3d b = model::point_in_world(w_, c.body_b, c.point_in_b);
    loop_r_.segment<3>(row) -=
        model::point_bias_acceleration(w_, c.body_a, a) - model::point_bias_acceleration(w_, c.body_b, b);
    row += 3;
  }
  solver_.add_level(loop_J_, loop_r_, kLoops);
  loop_rank_ = solver_.rank();
}

void Controller::solve(const Eigen::VectorXd& weight) {
  if (one_level_) {
    const auto& g = gathered_.front();
    if (solver_.add_full_level(H_, normal_force_, plan_.damping.damping, kFullRank)) return;
    if (!have_jacobian_) model::marker_jacobian(model_, w_, J_);
    have_jacobian_ = true;
    gather_level(plan_.levels.front(), 0, weight);
    solver_.add_level(g.J, g.r, plan_.damping);
    return;
  }
  close_loops();
  if (joined_)
    solve_joined();
  else
    for (const auto& g : gathered_) solver_.add_level(g.J, g.r, plan_.damping);
}

void Controller::solve_joined() {
  Eigen::Index rows = 0;
  for (const auto& g : gathered_) rows += g.r.size();
  joined_J_.resize(rows, model_.speed_count());
  joined_r_.resize(rows);
  rows = 0;
  for (const auto& g : gathered_) {
    joined_J_.middleRows(rows, g.r.size()) = g.J;
    joined_r_.segment(rows, g.r.size()) = g.r;
    rows += g.r.size();
  }
  solver_.add_level(joined_J_, joined_r_,
                    {.damping = kJoinedDamping, .truncation = plan_.damping.truncation});
}

void Controller::project_outside_force() {
  model::clear_forces(w_);
  model::add_force(w_, outside_.body, model::point_in_world(w_, outside_.body, outside_.point_in_body),
                   outside_.force_in_world);
  model::project_forces(model_, w_, outside_force_);
}

bool Controller::hold_at_limits() {
  // A coordinate may approach its limit no faster than a critically damped spring would bring it there: it
  // arrives without speed, and never beyond.
  const double omega = 0.5 * plan_.kd;
  bool more = false;
  for (const auto& c : model_.coordinates()) {
    const int k = c.speed_idx;
    if (k < 0 || held_[at(k)] != 0) continue;
    const double lowest = omega * (omega * (plan_.problem.lower[k] - x_[c.state_idx]) - 2.0 * v_[k]);
    const double highest = omega * (omega * (plan_.problem.upper[k] - x_[c.state_idx]) - 2.0 * v_[k]);
    const double bounded = std::min(std::max(a_[k], lowest), highest);
    if (std::abs(bounded - a_[k]) <= 1e-9 * (1.0 + std::abs(a_[k]))) continue;
    held_[at(k)] = 1;
    held_a_[k] = bounded;
    more = true;
  }
  return more;
}

bool Controller::evaluate(const GoalValues& goal, double time_s, const Eigen::Matrix3Xd& goal_acceleration,
                          double later_s) {
  ++steps_;
  if (!v_.allFinite() || !x_.allFinite() || v_.norm() > plan_.max_speed) return false;
  model::kinematics(model_, w_, x_);
  const bool goes_on = step_s_ > 0.0 && plan_.feed_forward;
  if (goes_on)
    find_marker_accelerations(a_, marker_ended_);
  else
    model::velocities(model_, w_, v_);
  model::mass_matrix(model_, w_, M_);
  find_commands(goal, time_s, goes_on ? goal_acceleration : goal.a, later_s);
  model::difference(model_, x_, plan_.rest, wished_);
  wished_ *= plan_.posture_kp;
  wished_ -= plan_.posture_kd * v_;
  have_jacobian_ = false;
  if (one_level_) {
    weight_ = goal.weight.cwiseProduct(plan_.in_levels);
    model::marker_normal_matrix(model_, w_, weight_, H_);
    model::clear_forces(w_);
    model::add_marker_forces(model_, w_, weight_, command_);
    model::project_forces(model_, w_, normal_force_);
    for (const auto& task : gathered_.front().tasks)
      for (Eigen::Index i = 0; i < task.error.size(); ++i) {
        H_.noalias() += task.weight[i] * task.jacobian.row(i).transpose() * task.jacobian.row(i);
        normal_force_ += task.weight[i] * task.error[i] * task.jacobian.row(i).transpose();
      }
  } else {
    model::marker_jacobian(model_, w_, J_);
    for (std::size_t i = 0; i < plan_.levels.size(); ++i) gather_level(plan_.levels[i], i, goal.weight);
  }
  if (outside_.body >= 0) project_outside_force();
  held_ = plan_.problem.fixed_speed;
  held_a_.setZero();
  now_a_ = a_;
  for (int round = 0; round < kMostHolds; ++round) {
    if (!solver_.begin(M_, held_, held_a_)) return false;
    solve(goal.weight);
    solver_.add_posture(wished_);
    if (outside_.body >= 0) solver_.add_outside_force(outside_force_, loop_rank_);
    a_ = solver_.acceleration();
    if (!hold_at_limits()) break;
  }
  rank_ = solver_.rank();
  smallest_ = rank_ > 0 ? solver_.smallest_pivot() : 0.0;
  if (plan_.feed_forward) find_marker_accelerations(a_, marker_begun_);
  // From later in the step before to later in this one.
  const double since = step_s_ - later_s_;
  if (goes_on)
    now_a_ += since / (since + later_s) * (a_ - now_a_);
  else
    now_a_ = a_;
  later_s_ = goes_on ? later_s : 0.0;
  return a_.allFinite();
}

void Controller::keep() {
  kept_x_ = x_;
  kept_v_ = v_;
  kept_a_ = a_;
}

void Controller::go_back() {
  x_ = kept_x_;
  v_ = kept_v_;
  a_ = kept_a_;
  forget_step();
  model::kinematics(model_, w_, x_);
  model::velocities(model_, w_, v_);
}

void Controller::advance(double h) {
  move_ = h * v_;
  move_ += 0.5 * h * h * a_;
  model::integrate(model_, x_, move_);
  v_ += h * a_;
  step_s_ = h;
  // Excess by rounding, or by a limit reached at the start.
  for (const auto& c : model_.coordinates()) {
    const int k = c.speed_idx;
    if (k < 0) continue;
    double& q = x_[c.state_idx];
    if (q < plan_.problem.lower[k]) {
      q = plan_.problem.lower[k];
      v_[k] = std::max(v_[k], 0.0);
    } else if (q > plan_.problem.upper[k]) {
      q = plan_.problem.upper[k];
      v_[k] = std::min(v_[k], 0.0);
    }
  }
}

}  // namespace kinemark::motion::internal
