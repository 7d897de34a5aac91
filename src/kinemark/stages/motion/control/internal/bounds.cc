// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/goal_task.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kBlindRotation = 1.0 / 0.003;  // rad per m of goal error, as for inverse kinematics
constexpr double kBlindTranslation = 20.0;      // m per m
constexpr double kNullShare = 1e-4;             // of a coordinate's square that no level fixes
constexpr double kAtLimit = 1e-9;               // rad or m
constexpr double kUnknownShare = 1e-6;          // of the squared gains that goals with a known SD have

}  // namespace

Bounds::Bounds(const Plan& plan)
    : plan_(plan),
      w_(plan.problem.model),
      fit_(plan.problem),
      levels_(plan.levels.size()),
      determined_(at(plan.problem.model.coordinate_count()), 0) {
  const int n = plan.problem.model.speed_count();
  Eigen::Index columns = 0;
  for (const auto& level : plan.levels) {
    first_column_.push_back(columns);
    columns += level.rows();
  }
  first_column_.push_back(columns);
  explained_.setZero(n, columns);
  V_.setZero(n, n);
  z_.setZero(n);
  still_.setZero(n);
  sd_.setZero(plan.problem.model.coordinate_count());
  bound_ = goal_error_ = goal_bound_ = beyond_ = sd_;
  force_.setZero(n);
  held_ = plan.problem.fixed_speed;
}

void Bounds::gather(std::size_t index, const GoalValues& goal, double time_s, const MarkerVariances& noise) {
  const auto& level = plan_.levels[index];
  Level& out = levels_[index];
  out.A.resize(J_.cols(), level.rows());
  for (auto* column : {&out.dx, &out.scale, &out.variance}) column->setZero(level.rows());
  Eigen::Index row = 0;
  for (const int m : level.markers) {
    const double scale = std::sqrt(goal.weight[m]);
    out.A.middleCols<3>(row) = scale * J_.middleRows<3>(3 * static_cast<Eigen::Index>(m)).transpose();
    if (scale > 0.0) out.dx.segment<3>(row) = scale * (goal.x.col(m) - w_.marker.col(m));
    out.scale.segment<3>(row).setConstant(scale);
    out.variance.segment<3>(row).setConstant(noise.own[m]);
    row += 3;
  }
  out.is_made.assign(at(level.rows()), 0);
  out.gains.resize(level.tasks.size());
  for (std::size_t t = 0; t < level.tasks.size(); ++t) {
    level.evaluate(t, plan_.problem, w_, goal, time_s, rows_, &out.gains[t]);
    for (Eigen::Index i = 0; i < rows_.error.size(); ++i, ++row) {
      const double scale = std::sqrt(rows_.weight[i]);
      out.A.col(row) = scale * rows_.jacobian.row(i).transpose();
      out.dx[row] = scale * rows_.error[i];
      out.scale[row] = scale;
      out.variance[row] = rows_.sd[i] * rows_.sd[i];
      out.is_made[at(row)] = level.about[t].made != nullptr ? 1 : 0;
    }
  }
  force_.noalias() += out.A * out.dx;
  for (Eigen::Index k = 0; k < J_.cols(); ++k)
    if (held_[at(k)] != 0) out.A.row(k).setZero();
  llt_.matrixL().solveInPlace(out.A);
}

void Bounds::add_level(std::size_t index) {
  Level& level = levels_[index];
  const Eigen::Index n = level.A.rows(), m = level.A.cols();
  level.dx.noalias() -= level.A.transpose() * z_;  // not explained by the levels above
  level.inverse.setZero(n, m);
  if (m == 0) return;
  level.projected = level.A;
  if (rank_ > 0) {
    const auto V = V_.leftCols(rank_);
    level.projected.noalias() -= V * (V.transpose() * level.A).eval();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(level.projected);
  const auto& upper = qr.matrixQR();
  const Eigen::Index most = std::min(m, n - rank_);
  const double floor = std::max(plan_.damping.truncation * std::abs(upper(0, 0)), 1e-9);
  Eigen::Index count = 0;
  while (count < most && std::abs(upper(count, count)) > floor) ++count;
  if (count > 0) {
    smallest_ = std::min(smallest_, std::abs(upper(count - 1, count - 1)));
    level.B.setIdentity(n, count);
    level.B.applyOnTheLeft(qr.householderQ());
    // A' = B R P': the pseudo-inverse of A is B (R R')^-1 R P'.
    level.R = upper.topRows(count).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd G = level.R * level.R.transpose();
    level.inverse.noalias() = level.B * G.llt().solve(level.R);
    level.inverse = level.inverse * qr.colsPermutation().transpose();
    V_.middleCols(rank_, count) = level.B;
    rank_ += static_cast<int>(count);
  }
  // Effect of the errors of all goals so far: A_i^+ (own rows - A_i times the part explained above).
  const Eigen::Index begin = first_column_[index];
  if (begin > 0)
    explained_.leftCols(begin) -= level.inverse * (level.A.transpose() * explained_.leftCols(begin)).eval();
  explained_.middleCols(begin, m) = level.inverse;
  z_.noalias() += level.inverse * level.dx;
}

bool Bounds::hold_pressed(const Eigen::VectorXd& x) {
  bool any = false;
  for (const auto& c : plan_.problem.model.coordinates()) {
    const int k = c.speed_idx;
    if (k < 0 || held_[at(k)] != 0) continue;
    const double q = x[c.state_idx];
    const bool pressed = (q <= plan_.problem.lower[k] + kAtLimit && force_[k] < 0.0) ||
                         (q >= plan_.problem.upper[k] - kAtLimit && force_[k] > 0.0);
    if (!pressed) continue;
    held_[at(k)] = 1;
    any = true;
  }
  return any;
}

void Bounds::find_coordinates(const Eigen::VectorXd& q) {
  model::coordinate_jacobian(plan_.problem.model, w_, q, E_);
  for (Eigen::Index k = 0; k < E_.cols(); ++k)
    if (held_[at(k)] != 0) E_.col(k).setZero();
  C_ = E_.transpose();
  llt_.matrixL().solveInPlace(C_);  // columns: coordinates in whitened space
}

void Bounds::measure(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal) {
  goal_error_.noalias() = C_.transpose() * z_;
  goal_bound_.setZero();
  for (const auto& level : levels_) {
    G_.noalias() = C_.transpose() * level.inverse;
    goal_bound_ += level.dx.norm() * G_.rowwise().norm();
  }
  find_way(x, q, goal);
}

void Bounds::find_way(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal) {
  beyond_.setZero();
  is_way_known_ = true;
  // Directions that no goal fixes have no best fit.
  const auto held = std::ranges::count(held_, std::uint8_t{1});
  if (!plan_.one_sum || rank_ + held < std::ssize(held_)) return;
  is_way_known_ = fit_.find(x, q, goal);
  if (!is_way_known_) return;
  goal_error_ = fit_.way();
  beyond_ = fit_.left().cwiseAbs();
  goal_bound_ = goal_bound_.cwiseMax(goal_error_.cwiseAbs() + beyond_);
}

void Bounds::find_marker_gains() {
  marker_gains_.setZero(G_.rows(), 3 * static_cast<Eigen::Index>(plan_.problem.model.marker_count()));
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const auto& level = plan_.levels[i];
    Eigen::Index column = first_column_[i];
    for (const int m : level.markers) {
      marker_gains_.middleCols<3>(3 * static_cast<Eigen::Index>(m)) += G_.middleCols<3>(column);
      column += 3;
    }
    for (std::size_t t = 0; t < level.tasks.size(); ++t) {
      const auto& gains = levels_[i].gains[t];
      for (Eigen::Index k = 0; 3 * k < gains.cols(); ++k)
        marker_gains_.middleCols<3>(3 * static_cast<Eigen::Index>(level.about[t].made->markers()[at(k)])) +=
            G_.middleCols(column, gains.rows()) * gains.middleCols<3>(3 * k);
      column += gains.rows();
    }
  }
}

void Bounds::judge(const MarkerVariances& noise) {
  const auto& model = plan_.problem.model;
  for (std::size_t i = 0; i < levels_.size(); ++i)
    for (Eigen::Index row = 0; row < levels_[i].scale.size(); ++row)
      explained_.col(first_column_[i] + row) *= levels_[i].scale[row];
  G_.noalias() = C_.transpose() * explained_;
  find_marker_gains();
  const auto V = V_.leftCols(rank_);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index c = 0; c < G_.rows(); ++c) {
    const double whole = C_.col(c).squaredNorm();
    const double fixed = (V.transpose() * C_.col(c)).squaredNorm();
    const bool rotation = model.description().coordinates[at(c)].is_rotation;
    bool sure = whole - fixed <= kNullShare * whole &&
                G_.row(c).norm() <= (rotation ? kBlindRotation : kBlindTranslation);
    double variance = 0.0, known = 0.0, unknown = 0.0;
    Eigen::RowVectorXd common = Eigen::RowVectorXd::Zero(3 * noise.common.size());
    for (Eigen::Index m = 0; m < noise.own.size(); ++m) {
      const auto part = marker_gains_.row(c).segment<3>(3 * m);
      const int body = model.markers()[at(m)].body;
      variance += noise.own[m] * part.squaredNorm();
      known += part.squaredNorm();
      if (body >= 0) common.segment<3>(3 * body) += part;
    }
    for (std::size_t i = 0; i < levels_.size(); ++i)
      for (Eigen::Index row = 3 * std::ssize(plan_.levels[i].markers); row < levels_[i].variance.size();
           ++row) {
        const double square = std::pow(G_(c, first_column_[i] + row), 2);
        variance += square * levels_[i].variance[row];
        if (levels_[i].is_made[at(row)] != 0) continue;
        known += square;
        if (levels_[i].variance[row] == 0.0) unknown += square;
      }
    for (Eigen::Index b = 0; b < noise.common.size(); ++b)
      variance += noise.common[b] * common.segment<3>(3 * b).squaredNorm();
    const double lag = is_way_known_ ? goal_error_[c] : goal_bound_[c];
    sd_[c] = std::sqrt(variance + lag * lag);
    sure = sure && sd_[c] <= kLargestSd;
    bound_[c] = sure ? std::abs(lag) + beyond_[c] + kNoiseSds * std::sqrt(variance) : nan;
    if (!sure) goal_bound_[c] = nan;
    if (!sure || !is_way_known_) goal_error_[c] = nan;
    // Fixed only by goals without a standard deviation.
    if (!sure || (unknown > 0.0 && known - unknown <= kUnknownShare * known)) sd_[c] = nan;
    determined_[at(c)] = sure ? 1 : 0;
  }
  for (const int c : plan_.locked) {  // locked here: nothing is known
    determined_[at(c)] = 0;
    sd_[c] = bound_[c] = goal_error_[c] = goal_bound_[c] = nan;
  }
}

void Bounds::solve_levels(const Eigen::VectorXd& q, const GoalValues& goal, double time_s,
                          const MarkerVariances& noise) {
  mass_ = M_;
  hold_speeds(mass_, held_);
  llt_.compute(mass_);
  rank_ = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  z_.setZero();
  force_.setZero();
  explained_.setZero();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    gather(i, goal, time_s, noise);
    add_level(i);
  }
  if (rank_ == 0) smallest_ = 0.0;
  find_coordinates(q);
}

void Bounds::find(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal, double time_s,
                  const MarkerVariances& noise) {
  const auto& model = plan_.problem.model;
  model::kinematics(model, w_, x);
  model::velocities(model, w_, still_);
  model::mass_matrix(model, w_, M_);
  model::marker_jacobian(model, w_, J_);
  held_ = plan_.problem.fixed_speed;
  solve_levels(q, goal, time_s, noise);
  if (hold_pressed(x)) {
    solve_levels(q, goal, time_s, noise);
    measure(x, q, goal);
    held_ = plan_.problem.fixed_speed;
    solve_levels(q, goal, time_s, noise);
  } else {
    measure(x, q, goal);
  }
  judge(noise);
}

void Bounds::stack(const Eigen::Matrix3Xd& error) {
  stacked_.setZero(explained_.cols());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const auto& level = plan_.levels[i];
    Eigen::Index row = 0;
    for (const int m : level.markers) {
      if (levels_[i].scale[row] > 0.0) stacked_.segment<3>(first_column_[i] + row) = error.col(m);
      row += 3;
    }
    for (std::size_t t = 0; t < level.tasks.size(); ++t) {
      const auto& gains = levels_[i].gains[t];
      for (Eigen::Index k = 0; 3 * k < gains.cols(); ++k)
        stacked_.segment(first_column_[i] + row, gains.rows()) +=
            gains.middleCols<3>(3 * k) * error.col(level.about[t].made->markers()[at(k)]);
      row += gains.rows();
    }
  }
}

Eigen::VectorXd Bounds::coordinates_of(const Eigen::Matrix3Xd& error) {
  stack(error);
  return G_ * stacked_;
}

Eigen::VectorXd Bounds::variance_of(const Eigen::VectorXd& variance) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(G_.rows());
  for (Eigen::Index m = 0; m < variance.size(); ++m)
    out += variance[m] * marker_gains_.middleCols<3>(3 * m).rowwise().squaredNorm();
  return out;
}

void Bounds::unexplained(const Eigen::Matrix3Xd& error, Eigen::VectorXd& squares, Eigen::VectorXd& freedom) {
  stack(error);
  const Eigen::VectorXd change = explained_ * stacked_;
  squares.setZero(error.cols());
  freedom.setZero(error.cols());
  for (std::size_t i = 0; i < levels_.size(); ++i)
    for (std::size_t j = 0; j < plan_.levels[i].markers.size(); ++j) {
      const int m = plan_.levels[i].markers[j];
      for (Eigen::Index row = 3 * static_cast<Eigen::Index>(j), end = row + 3; row < end; ++row) {
        const double scale = levels_[i].scale[row];
        if (!(scale > 0.0)) continue;
        const auto slope = levels_[i].A.col(row) / scale;
        const double left = stacked_[first_column_[i] + row] - slope.dot(change);
        squares[m] += left * left;
        freedom[m] += 1.0 - slope.dot(explained_.col(first_column_[i] + row));
      }
    }
}

}  // namespace kinemark::motion::internal
