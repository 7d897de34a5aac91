// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/profile_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kVaguest = 1e-2;  // 1 / (10 rad or m)^2
constexpr double kLocked = 1e12;
constexpr double kShutLoopSd_m = 1e-5;

using Eigen::VectorXd;

constexpr double kWeak = 0.03;          // rad or m: what is known better is linear enough
constexpr double kLooser = 2.0;         // times the variance with all markers: it lost what held it
constexpr double kMostMoved = 1.5;      // rad or m, of a direction's largest part
constexpr std::size_t kMost = 12;       // directions
constexpr double kOpenSd = 9.9;         // rad or m, and ...
constexpr double kMovesNothing = 1e-9;  // ... all other speeds by less: no marker that is seen moves with it
constexpr double kFirst = 2.0;  // deviations, the first place to ask; each further one is 1.6 times as far
constexpr double kFurther = 1.6;
constexpr double kLinear = 0.5;   // of the rise of a linear model: what rises by less is not linear
constexpr double kEnough = 16.0;  // rise of chi-square beyond which a pose is not asked
constexpr int kMostSteps = 20;
constexpr double kLongestMove = 0.5;  // rad or m, of any speed
constexpr int kMostHalved = 5;
constexpr int kTrusted = 3;        // steps after which one that cannot lead to a fit is believed
constexpr double kSettled = 0.01;  // of chi-square, by which the next step would lower it

}  // namespace

void SpeedCovariance::factor(model::Workspace& w, const Eigen::VectorXd& information, Eigen::Index held) {
  const auto& model = problem_.model;
  model::marker_normal_matrix(model, w, information, H_);
  if (!model.point_constraints().empty()) {
    model::point_constraint_jacobian(model, w, C_);
    H_.noalias() += C_.transpose() * C_ / (kShutLoopSd_m * kShutLoopSd_m);
  }
  for (Eigen::Index i = 0; i < H_.rows(); ++i) {
    if (!problem_.fixed_speed[at(i)] && i != held) {
      H_(i, i) += kVaguest;
      continue;
    }
    H_.row(i).setZero();
    H_.col(i).setZero();
    H_(i, i) = kLocked;
  }
  llt_.compute(H_);
}

void SpeedCovariance::invert(Eigen::MatrixXd& K) const {
  K.setIdentity(H_.rows(), H_.cols());
  llt_.solveInPlace(K);
}

ProfileErrors::ProfileErrors(const Problem& problem)
    : problem_(problem),
      w_(problem.model),
      covariance_(problem),
      residual_(3, problem.model.marker_count()),
      step_(problem.model.speed_count()),
      q_(problem.model.coordinate_count()) {}

/// Pivoted Cholesky factors of K: each is one standard deviation of what the ones before it leave open.
void ProfileErrors::find_directions() {
  directions_.clear();
  while (directions_.size() < kMost) {
    Eigen::Index i = 0;
    const double most =
        (K_.diagonal().array() > kLooser * whole_.array()).select(K_.diagonal(), 0.0).maxCoeff(&i);
    if (!(most > kWeak * kWeak)) return;
    VectorXd v = K_.col(i) / std::sqrt(most);
    K_.noalias() -= v * v.transpose();
    const double own = std::exchange(v[i], 0.0);
    if (own > kOpenSd && !(v.cwiseAbs().maxCoeff() > kMovesNothing)) continue;
    v[i] = own;
    directions_.push_back({.speed = i, .along = std::move(v)});
  }
}

/// Chi-square of a state; leaves the workspace there.
double ProfileErrors::residuals(const VectorXd& state) {
  model::kinematics(problem_.model, w_, state);
  residual_ = *y_ - w_.marker;
  double chi_square = 0.0;
  for (Eigen::Index m = 0; m < information_->size(); ++m)
    if ((*information_)[m] > 0.0) chi_square += (*information_)[m] * residual_.col(m).squaredNorm();
  return chi_square;
}

/// Gauss-Newton steps with one speed held, shortened while they lead uphill: a limb that the markers leave
/// open would swing to and fro, and hide what the others show. Chi-square where they end.
double ProfileErrors::settle(VectorXd& state, Eigen::Index held) {
  double chi_square = residuals(state);
  for (int k = 0; k < kMostSteps; ++k) {
    model::clear_forces(w_);
    model::add_marker_forces(problem_.model, w_, *information_, residual_);
    model::project_forces(problem_.model, w_, step_);
    force_ = step_;
    covariance_.factor(w_, *information_, held);
    covariance_.solve(step_);
    const double longest = step_.cwiseAbs().maxCoeff();
    if (!std::isfinite(longest)) return HUGE_VAL;
    const double less = step_.dot(force_);  // chi-square, were the model linear
    if (less < kSettled || (k >= kTrusted && chi_square - less > chi_square_ + kEnough)) return chi_square;
    if (longest > kLongestMove) step_ *= kLongestMove / longest;
    bool lower = false;
    for (int halved = 0; !lower && halved < kMostHalved; ++halved) {
      tried_ = state;
      model::integrate(problem_.model, tried_, step_);
      const double tried = residuals(tried_);
      lower = tried <= chi_square;
      if (lower) chi_square = tried;
      step_ *= 0.5;
    }
    if (!lower) return chi_square;
    state = tried_;
  }
  return chi_square;
}

/// Ask at places ever further along one direction, as long as chi-square rises by less than `least` of what
/// it would were the model linear; lacks_ becomes what they show.
void ProfileErrors::profile(const Direction& direction, double sign, double least, Drags drags) {
  const auto& v = direction.along;
  const double farthest =
      kMostMoved / (drags == Drags::counted ? v.cwiseAbs().maxCoeff() : std::abs(v[direction.speed]));
  double before = 0.0;
  moved_ = best_;
  for (double s = std::min(kFirst, farthest);; s = std::min(kFurther * s, farthest)) {
    step_ = sign * (s - before) * v;
    if (drags == Drags::left_behind) {
      const double own = std::exchange(step_[direction.speed], 0.0);
      if (const double longest = step_.cwiseAbs().maxCoeff(); longest > kLongestMove)
        step_ *= kLongestMove / longest;
      step_[direction.speed] = own;
    }
    model::integrate(problem_.model, moved_, step_);
    const double rise = settle(moved_, direction.speed) - chi_square_;
    if (!(rise < std::min(kEnough, least * s * s))) return;
    model::coordinates_from_state(problem_.model, moved_, q_best_, q_);
    for (Eigen::Index c = 0; c < q_.size(); ++c) {
      const double gone = q_[c] - q_best_[c], linear = linear_[c];
      lacks_[c] = std::max(lacks_[c], gone * gone / std::max(rise, 1.0) - linear * linear);
    }
    if (s >= farthest) return;
    before = s;
  }
}

void ProfileErrors::add(const VectorXd& x, const Eigen::Matrix3Xd& y, const VectorXd& information,
                        const VectorXd& all, const Eigen::MatrixXd& E, VectorXd& variance) {
  y_ = &y;
  information_ = &information;
  model::kinematics(problem_.model, w_, x);
  covariance_.factor(w_, all);
  covariance_.invert(K_);
  whole_ = K_.diagonal();
  covariance_.factor(w_, information);
  covariance_.invert(K_);
  known_ = K_;
  find_directions();
  if (directions_.empty()) return;
  best_ = x;
  chi_square_ = HUGE_VAL;
  chi_square_ = settle(best_, -1);
  q_best_.resize(q_.size());
  q_best_.setZero();
  model::coordinates_from_state(problem_.model, best_, q_best_, q_best_);
  for (const auto& direction : directions_) {
    linear_.noalias() = E * direction.along;
    lacks_.setZero(q_.size());
    for (const double sign : {-1.0, 1.0}) profile(direction, sign, HUGE_VAL, Drags::counted);
    variance += lacks_;
  }
  if (kFirst * directions_.front().along.cwiseAbs().maxCoeff() > kMostMoved) ask_what_is_known(E, variance);
}

/// A coordinate that is at its largest along the poses that fit does not move with what is open to first
/// order (a chain that is nearly straight does so), and goes with it for a small part of the chi-square of a
/// linear model: each known one is held by itself.
void ProfileErrors::ask_what_is_known(const Eigen::MatrixXd& E, VectorXd& variance) {
  for (Eigen::Index c = 0; c < E.rows(); ++c) {
    Eigen::Index i = 0;
    if (!(E.row(c).cwiseAbs().maxCoeff(&i) > 0.0)) continue;
    const double own = known_(i, i);
    if (!(own > 0.0 && own <= kWeak * kWeak)) continue;
    const Direction direction{.speed = i, .along = known_.col(i) / std::sqrt(own)};
    linear_.noalias() = E * direction.along;
    lacks_.setZero(q_.size());
    for (const double sign : {-1.0, 1.0}) profile(direction, sign, kLinear, Drags::left_behind);
    variance[c] += lacks_[c];
  }
}

}  // namespace kinemark::motion::internal
