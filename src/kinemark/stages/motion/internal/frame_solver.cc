// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/frame_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kLever_m = 0.1;  // converts radians to metres where both must be compared
constexpr double kFloor =
    1e-10;  // relative damping that is always added: keeps undetermined directions at rest
constexpr double kNewtonDone = 1e-6;  // an exact Newton step below this leaves an error of its square
constexpr int kPatience = 12;         // iterations after which slow progress ends the search:
constexpr double kFlat = 1e-10;       // of the cost: smallest gain of a step that continues it
constexpr double kLinearDone = 1e-9;  // a Gauss-Newton step below this leaves an error of its own size

}  // namespace

FrameSolver::FrameSolver(const Problem& problem, const IkOptions& options)
    : problem_(problem), options_(options), model_(problem.model), w_(problem.model) {
  const int n = model_.speed_count(), M = model_.marker_count();
  const auto K = 3 * static_cast<Eigen::Index>(model_.point_constraints().size());
  residual_.setZero(3, M);
  effective_weight_.setZero(M);
  for (auto* v : {&g_, &dx_, &diagonal_}) v->setZero(n);
  gap_.setZero(K);
  multiplier_.setZero(K);
  q_.setZero(model_.coordinate_count());
  gauss_newton_.setZero(n, n);
  H_.setZero(n, n);
  C_.setZero(K, n);
  HinvC_.setZero(n, K);
  loop_.setZero(K, K);
  E_.setZero(model_.coordinate_count(), n);
  llt_ = Eigen::LLT<Eigen::MatrixXd>(n);
  loop_llt_ = Eigen::LLT<Eigen::MatrixXd>(K);
  held_ = problem.fixed_speed;
  x_try_.setZero(model_.state_count());
  scale_.setConstant(n, kLever_m * kLever_m);
  for (int c = 0; c < model_.coordinate_count(); ++c) {
    const auto& coordinate = model_.coordinates()[at(c)];
    if (coordinate.speed_idx >= 0 && !model_.description().coordinates[at(c)].is_rotation)
      scale_[coordinate.speed_idx] = 1.0;
  }
  for (const auto& free : model_.free_joints()) scale_.segment<3>(free.speed_idx).setOnes();
  for (const auto& task : problem.coordinate_tasks)
    tasks_on_free_joints_ =
        tasks_on_free_joints_ || model_.coordinates()[at(task.coordinate)].free_joint >= 0;
}

double FrameSolver::merit() const { return cost_ + loop_penalty_ * gap_.lpNorm<1>(); }

double FrameSolver::visit(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                          const Eigen::VectorXd& x) {
  model::kinematics(model_, w_, x);
  double sum = 0.0;
  const double s = options_.loss_scale_m;
  for (Eigen::Index m = 0; m < weight.size(); ++m) {
    if (weight[m] == 0.0) {
      residual_.col(m).setZero();
      effective_weight_[m] = 0.0;
      continue;
    }
    residual_.col(m) = y.col(m) - w_.marker.col(m);
    const double r2 = residual_.col(m).squaredNorm();
    double rho = r2, slope = 1.0;  // loss and its derivative by r2
    if (options_.loss == Loss::huber && r2 > s * s) {
      const double r = std::sqrt(r2);
      rho = 2.0 * s * r - s * s;
      slope = s / r;
    } else if (options_.loss == Loss::cauchy) {
      rho = s * s * std::log1p(r2 / (s * s));
      slope = 1.0 / (1.0 + r2 / (s * s));
    }
    sum += weight[m] * rho;
    effective_weight_[m] = weight[m] * slope;
  }
  // All terms are multiplied by the total weight, so that the marker part is a plain weighted sum.
  cost_ = sum;
  if (tasks_on_free_joints_) model::coordinates_from_state(model_, x, q_, q_);
  for (const auto& task : problem_.coordinate_tasks) {
    const double miss = task.target(frame) - task_value(task);
    cost_ += total_weight_ * task.weight * miss * miss;
  }
  if (gap_.size() > 0) model::point_constraint_gaps(model_, w_, gap_);
  return merit();
}

double FrameSolver::task_value(const Problem::CoordinateTarget& task) const {
  return model_.coordinates()[at(task.coordinate)].free_joint >= 0 ? q_[task.coordinate]
                                                                   : w_.q[task.coordinate];
}

// Coordinate tasks enter like one more residual each, with the row of dq/dv as its derivative. That row has
// one entry, except for the Euler angles of a free joint.
void FrameSolver::add_coordinate_tasks(std::int64_t frame) {
  if (tasks_on_free_joints_) model::coordinate_jacobian(model_, w_, q_, E_);
  for (const auto& task : problem_.coordinate_tasks) {
    const double weight = total_weight_ * task.weight;
    const double miss = task.target(frame) - task_value(task);
    const int speed = problem_.speed_of(task.coordinate);
    if (speed >= 0) {
      const double slope = w_.q_slope[task.coordinate];
      g_[speed] += weight * miss * slope;
      gauss_newton_(speed, speed) += weight * slope * slope;
    } else if (model_.coordinates()[at(task.coordinate)].free_joint >= 0) {
      const auto row = E_.row(task.coordinate);
      for (Eigen::Index i = 0; i < row.size(); ++i) {
        g_[i] += weight * miss * row[i];
        for (Eigen::Index j = 0; j < row.size(); ++j) gauss_newton_(i, j) += weight * row[i] * row[j];
      }
    }
  }
}

// Locked speeds never move; limited ones rest while the gradient pushes them against their limit.
void FrameSolver::fix_speeds(const Eigen::VectorXd& x) {
  held_ = problem_.fixed_speed;
  for (const auto& c : model_.coordinates()) {
    if (c.speed_idx < 0) continue;
    const double value = x[c.state_idx], slack = 1e-12;
    if ((value <= problem_.lower[c.speed_idx] + slack && g_[c.speed_idx] <= 0.0) ||
        (value >= problem_.upper[c.speed_idx] - slack && g_[c.speed_idx] >= 0.0))
      held_[at(c.speed_idx)] = 1;
  }
}

bool FrameSolver::step(double damping, bool exact) {
  H_ = gauss_newton_;
  if (exact) model::subtract_force_curvature(model_, w_, H_);
  const Eigen::Index n = H_.rows();
  H_.diagonal() += (damping + kFloor) * total_weight_ * scale_;
  dx_ = g_;
  if (gap_.size() > 0) {
    // Stiffness across the loops does not change a step that closes them, but keeps the matrix positive
    // definite.
    const double stiffness = 10.0 * total_weight_;
    HinvC_ = stiffness * C_.transpose();
    H_.noalias() += HinvC_ * C_;
    dx_.noalias() -= HinvC_ * gap_;
  }
  hold_speeds(H_, held_);
  for (Eigen::Index i = 0; i < n; ++i)
    if (held_[at(i)] != 0) dx_[i] = 0.0;
  llt_.compute(H_);
  if (llt_.info() != Eigen::Success) return false;
  llt_.solveInPlace(dx_);
  if (gap_.size() > 0) {
    // Closed loops: C dx = -gap, by the Schur complement; a little damping where loops are redundant.
    for (Eigen::Index i = 0; i < n; ++i)
      if (held_[at(i)]) C_.col(i).setZero();
    HinvC_ = C_.transpose();
    llt_.solveInPlace(HinvC_);
    loop_.noalias() = C_ * HinvC_;
    loop_.diagonal().array() += 1e-12 * (loop_.trace() / static_cast<double>(loop_.rows()) + 1e-300);
    loop_llt_.compute(loop_);
    if (loop_llt_.info() != Eigen::Success) return false;
    multiplier_.noalias() = C_ * dx_;
    multiplier_ += gap_;
    loop_llt_.solveInPlace(multiplier_);
    dx_.noalias() -= HinvC_ * multiplier_;
  }
  return dx_.allFinite();
}

void FrameSolver::clip_to_limits(const Eigen::VectorXd& x) {
  const double longest = dx_.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) dx_ *= kLongestStep / longest;
  for (const auto& c : model_.coordinates()) {
    if (c.speed_idx < 0) continue;
    const double low = problem_.lower[c.speed_idx] - x[c.state_idx],
                 high = problem_.upper[c.speed_idx] - x[c.state_idx];
    dx_[c.speed_idx] = std::clamp(dx_[c.speed_idx], std::min(low, 0.0), std::max(high, 0.0));
  }
}

FrameSolver::Outcome FrameSolver::solve(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight,
                                        std::int64_t frame, Eigen::VectorXd& x) {
  Outcome outcome;
  total_weight_ = weight.sum();
  const bool looped = gap_.size() > 0;
  multiplier_.setZero();
  loop_penalty_ = 0.0;
  for (const auto& c : model_.coordinates())  // a start outside the limits is moved inside first
    if (c.speed_idx >= 0 && !problem_.fixed_speed[at(c.speed_idx)])
      x[c.state_idx] = std::clamp(x[c.state_idx], problem_.lower[c.speed_idx], problem_.upper[c.speed_idx]);
  problem_.prescribe(frame, x);

  double merit_now = visit(y, weight, frame, x);
  double damping = 0.0;
  bool stale = false;  // the workspace holds a pose that was refused
  for (int i = 0; i < options_.max_iterations; ++i) {
    ++outcome.iterations;
    if (stale) merit_now = visit(y, weight, frame, x);
    stale = false;
    model::clear_forces(w_);
    model::add_marker_forces(model_, w_, effective_weight_, residual_);
    if (looped) {
      // The loop forces contribute to the second derivatives (Hessian of the Lagrangian), but not to the
      // gradient.
      const auto constraints = model_.point_constraints();
      for (std::size_t k = 0; k < constraints.size(); ++k) {
        const Eigen::Vector3d f = multiplier_.segment<3>(3 * static_cast<Eigen::Index>(k));
        model::add_force(w_, constraints[k].body_a,
                         model::point_in_world(w_, constraints[k].body_a, constraints[k].point_in_a), -f);
        model::add_force(w_, constraints[k].body_b,
                         model::point_in_world(w_, constraints[k].body_b, constraints[k].point_in_b), f);
      }
      model::point_constraint_jacobian(model_, w_, C_);
    }
    model::project_forces(model_, w_, g_);
    if (looped) g_.noalias() += C_.transpose() * multiplier_;
    model::marker_normal_matrix(model_, w_, effective_weight_, gauss_newton_);
    add_coordinate_tasks(frame);
    fix_speeds(x);

    // The exact Hessian where it is positive definite, else Gauss-Newton; more damping after a refused step.
    // Damped steps along closed loops stay with Gauss-Newton: the loop forces are not settled there.
    const bool exact = options_.loss == Loss::square && (damping == 0.0 || !looped) && step(damping, true);
    if (!exact) {
      while (!step(damping, false) && damping < 1e12) damping = std::max(1e-6, 10.0 * damping);
      if (!dx_.allFinite()) break;
    }
    if (looped)
      loop_penalty_ = std::max(loop_penalty_, 4.0 * multiplier_.cwiseAbs().maxCoeff() + total_weight_ * 1e-3);
    clip_to_limits(x);
    const double length = dx_.cwiseAbs().maxCoeff();
    const double merit_before = looped ? merit() : merit_now;
    x_try_ = x;
    model::integrate(model_, x_try_, dx_);
    const double merit_try = visit(y, weight, frame, x_try_);
    const bool tiny = length < (exact && damping == 0.0 ? kNewtonDone : kLinearDone) ||
                      (i >= kPatience && !looped && damping < 1.0 && g_.dot(dx_) < kFlat * merit_now);
    if (merit_try <= merit_before * (1.0 + 1e-13) + 1e-18 * total_weight_ || (tiny && !looped)) {
      if (merit_try <= merit_before || tiny)
        x = x_try_;
      else
        stale = true;
      merit_now = merit_try;
      damping = damping < 1e-5 ? 0.0 : 0.1 * damping;
      if (tiny && (!looped || gap_.cwiseAbs().maxCoeff() < 1e-9)) {
        outcome.converged = true;
        break;
      }
    } else {
      if (tiny) {  // cannot improve in this precision
        outcome.converged = !looped || gap_.cwiseAbs().maxCoeff() < 1e-7;
        stale = true;
        break;
      }
      stale = true;
      damping = std::max(1e-4, 10.0 * damping);
      if (damping > 1e8) break;
    }
  }
  if (stale) visit(y, weight, frame, x);
  outcome.cost = total_weight_ > 0.0 ? cost_ / total_weight_ : 0.0;
  iterations_ += outcome.iterations;
  ++solves_;
  return outcome;
}

double FrameSolver::square_cost(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                                const Eigen::VectorXd& x) {
  total_weight_ = weight.sum();
  if (total_weight_ == 0.0) return 0.0;
  visit(y, weight, frame, x);
  double sum = 0.0;
  for (Eigen::Index m = 0; m < weight.size(); ++m) sum += weight[m] * residual_.col(m).squaredNorm();
  sum /= total_weight_;
  for (const auto& task : problem_.coordinate_tasks) {
    const double miss = task.target(frame) - task_value(task);
    sum += task.weight * miss * miss;
  }
  return sum;
}

}  // namespace kinemark::motion::internal
