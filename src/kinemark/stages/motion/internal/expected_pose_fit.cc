// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/expected_pose_fit.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/weighted_normal.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/internal/held_speeds.h"

namespace kinemark::motion::internal {
namespace {

constexpr int kRounds = 12;              // of reweighting
constexpr double kTuning = 3.0;          // standard deviations at which a sample has lost 3/4 of its weight
constexpr double kThirdOfThree = 1.239;  // a third of all lengths of three standard normal numbers lies below
constexpr double kRoughest = 3.0;        // a frame may be rougher than its recording by that
constexpr double kLoopSd_m = 1e-5;       // closed loops are kept shut to that
constexpr double kCalm = 5.0;            // when no sample is farther than that, all are taken
constexpr double kSettled = 3e-4;        // rad or m: a step below it ends the search

}  // namespace

ExpectedPoseFit::ExpectedPoseFit(const Problem& problem) : problem_(problem), w_(problem.model) {
  const int n = problem.model.speed_count(), M = problem.model.marker_count();
  residual_.setZero(3, M);
  for (auto* v : {&weight_, &distance_, &length_}) v->setZero(M);
  for (auto* v : {&moved_, &g_}) v->setZero(n);
  x_ = problem.model.default_state();
  H_.setZero(n, n);
  J_.setZero(3, n);
  KJ_.setZero(n, 3);
  llt_ = Eigen::LLT<Eigen::MatrixXd>(n);
  rejected_.assign(at(M), 0);
}

void ExpectedPoseFit::visit(const Expectation& expected) {
  const auto& model = problem_.model;
  model::kinematics(model, w_, x_);
  for (Eigen::Index m = 0; m < expected.position.cols(); ++m)
    w_.marker.col(m) = model::point_in_world(w_, model.markers()[at(m)].body, expected.position.col(m));
}

void ExpectedPoseFit::build(const Expectation& expected) {
  const auto& model = problem_.model;
  model::clear_forces(w_);
  model::add_marker_forces(model, w_, weight_, residual_);
  model::project_forces(model, w_, g_);
  model::marker_normal_matrix(model, w_, weight_, H_);
  const auto information = expected.speed_sd.array().square().inverse();
  H_.diagonal().array() += information;
  g_.array() -= information * moved_.array();
  if (!model.point_constraints().empty()) {
    model::point_constraint_gaps(model, w_, gap_);
    model::point_constraint_jacobian(model, w_, C_);
    H_.noalias() += (C_.transpose() * C_) / (kLoopSd_m * kLoopSd_m);
    g_.noalias() -= C_.transpose() * gap_ / (kLoopSd_m * kLoopSd_m);
  }
  hold_speeds(H_, problem_.fixed_speed);
  for (Eigen::Index i = 0; i < g_.size(); ++i)
    if (problem_.fixed_speed[at(i)] != 0) g_[i] = 0.0;
  llt_.compute(H_);
}

Eigen::VectorXd ExpectedPoseFit::information(const Expectation& expected, const Eigen::VectorXd& seen) {
  x_ = expected.x;
  moved_.setZero();
  residual_.setZero();
  for (Eigen::Index m = 0; m < seen.size(); ++m) {
    const bool known = seen[m] > 0.0 && std::isfinite(expected.position_sd[m]);
    weight_[m] = known ? 1.0 / (expected.position_sd[m] * expected.position_sd[m]) : 0.0;
  }
  visit(expected);
  build(expected);
  find_variance();
  Eigen::VectorXd gained =
      (variance_.array().inverse() - expected.speed_sd.array().square().inverse()).cwiseMax(0.0);
  for (Eigen::Index i = 0; i < gained.size(); ++i)
    if (problem_.fixed_speed[at(i)]) gained[i] = HUGE_VAL;
  return gained;
}

double ExpectedPoseFit::step(const Expectation& expected) {
  build(expected);
  llt_.solveInPlace(g_);
  if (!g_.allFinite()) return 0.0;
  const double longest = g_.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) g_ *= kLongestStep / longest;
  model::integrate(problem_.model, x_, g_);
  model::difference(problem_.model, expected.x, x_, moved_);
  return longest;
}

void ExpectedPoseFit::solve(const Expectation& expected, const Eigen::Matrix3Xd& y,
                            const Eigen::VectorXd& seen) {
  const Eigen::Index M = seen.size();
  const auto& model = problem_.model;
  x_ = expected.x;
  moved_.setZero();
  distance_.setZero();
  length_.setZero();
  std::ranges::fill(rejected_, std::uint8_t{0});
  const auto known = [&](Eigen::Index m) { return seen[m] > 0.0 && std::isfinite(expected.position_sd[m]); };
  // Away from what is expected by how many of its own standard deviations.
  const auto compare = [&] {
    sorted_.clear();
    for (Eigen::Index m = 0; m < M; ++m) {
      residual_.col(m).setZero();
      if (!known(m)) continue;
      residual_.col(m) = y.col(m) - w_.marker.col(m);
      length_[m] = residual_.col(m).norm();
      distance_[m] = length_[m] / expected.position_sd[m];
      sorted_.push_back(distance_[m]);
    }
  };
  const auto roughness = [&](double most) {
    if (sorted_.empty()) return 1.0;
    return std::clamp(math::nth_smallest(sorted_, (sorted_.size() - 1) / 3) / kThirdOfThree, 1.0, most);
  };
  // Robust weights, from the expected pose on: a sample far from it never gains weight.
  double settled = 1.0;
  for (int round = 0; round < kRounds && settled > kSettled; ++round) {
    visit(expected);
    compare();
    if (round > 0 && distance_.maxCoeff() < kCalm) {
      if (seen.minCoeff() > 0.0)
        variance_.setZero(moved_.size());
      else
        find_variance();
      return;
    }
    const double unit = roughness(HUGE_VAL);
    for (Eigen::Index m = 0; m < M; ++m) {
      const double a = distance_[m] / (kTuning * unit);
      const double slope = 1.0 / (1.0 + a * a);
      weight_[m] = known(m) ? slope * slope / (expected.position_sd[m] * expected.position_sd[m]) : 0.0;
    }
    settled = step(expected);
  }
  // Take in what agrees, then judge the rest by the pose and its uncertainty.
  for (int round = 0; round < 3; ++round) {
    visit(expected);
    compare();
    const double unit = roughness(kRoughest);
    for (Eigen::Index m = 0; m < M; ++m) {
      const bool taken = known(m) && !rejected_[at(m)] && (round > 0 || distance_[m] <= kTuning * unit);
      weight_[m] = taken ? 1.0 / (unit * unit * expected.position_sd[m] * expected.position_sd[m]) : 0.0;
    }
    step(expected);
    visit(expected);
    compare();
    bool changed = false;
    for (Eigen::Index m = 0; m < M; ++m) {
      if (!known(m)) continue;
      const double sd = unit * expected.position_sd[m];
      if (weight_[m] > 0.0) {
        distance_[m] = length_[m] / sd;
        rejected_[at(m)] = 0;
        continue;
      }
      model::point_jacobian(model, w_, model.markers()[at(m)].body, w_.marker.col(m), J_);
      for (Eigen::Index i = 0; i < J_.cols(); ++i)
        if (problem_.fixed_speed[at(i)]) J_.col(i).setZero();
      KJ_ = J_.transpose();
      llt_.solveInPlace(KJ_);
      Eigen::Matrix3d S = J_ * KJ_;
      S.diagonal().array() += sd * sd;
      distance_[m] = std::sqrt(std::max(0.0, residual_.col(m).dot(S.ldlt().solve(residual_.col(m)))));
      const std::uint8_t out = distance_[m] > expected.bound[m];
      changed = changed || out != rejected_[at(m)] || (!out && round == 0);
      rejected_[at(m)] = out;
    }
    if (!changed) break;
  }
  find_variance();
}

void ExpectedPoseFit::find_variance() {
  H_.setIdentity();
  llt_.solveInPlace(H_);
  variance_ = H_.diagonal();
}

}  // namespace kinemark::motion::internal
