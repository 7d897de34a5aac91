// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/internal/whole_trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/smoother/internal/step_prior.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::int64_t kOneSegment = 1024, kSegment = 256;  // frames whose factors are in memory at once
// Prior SD (rad or m) over the whole recording of a speed that nothing determines.
constexpr double kDone = 1e-4;  // half the squared step over its variance: 0.015 standard deviations
constexpr int kHalvings = 10;
constexpr int kRounds = 12;  // in which the coordinates at a limit are found, at most
constexpr double kFar = 1e100;
constexpr double kSpring = 1e6;        // at a limit, over what else holds a coordinate
constexpr double kPriorOfStep = 20.0;  // 1 + 9 + 9 + 1: how the prior holds one frame

}  // namespace

WholeTrajectory::WholeTrajectory(const model::Model& model, const Observations& observations,
                                 std::int64_t frames, const MatrixXd& step_precision, SpeedBounds bounds)
    : model_(model),
      observations_(observations),
      frames_(frames),
      segment_(frames <= kOneSegment ? frames : kSegment),
      bounds_(std::move(bounds)),
      rows_(model),
      prior_(model, step_precision),
      window_(model.speed_count()),
      floor_(1.0 / (kFloorSd * kFloorSd * static_cast<double>(frames))) {
  check(frames >= 4, "a trajectory needs four frames or more");
  const auto n = static_cast<Index>(model.speed_count());
  gradient_.setZero(n, frames);
  step_.setZero(n, frames);
  side_.assign(at(n * frames), 0);
  factors_.resize(at(segment_));
}

double WholeTrajectory::cost(const MatrixXd& states) {
  double sum = 0.0;
  for (std::int64_t k = 0; k < frames_; ++k) {
    sum += rows_.visit(observations_, k, states.col(k));
    if (k + 3 < frames_)
      sum += prior_.visit(states.col(k), states.col(k + 1), states.col(k + 2), states.col(k + 3));
  }
  return sum;
}

double WholeTrajectory::evaluate(const MatrixXd& states) {
  double sum = 0.0;
  gradient_.setZero();
  for (std::int64_t k = 0; k < frames_; ++k) {
    sum += rows_.visit(observations_, k, states.col(k));
    rows_.descent(g_);
    gradient_.col(k) -= g_;
    if (k + 3 >= frames_) continue;
    sum += prior_.visit(states.col(k), states.col(k + 1), states.col(k + 2), states.col(k + 3));
    for (int a = 0; a < 4; ++a) prior_.add_gradient(a, gradient_.col(k + a));
  }
  return sum;
}

template <class Visit>
void WholeTrajectory::each_limited(const MatrixXd& states, const Visit& visit) {
  const Index n = gradient_.rows();
  for (std::int64_t k = 0; k < frames_; ++k)
    for (const auto& c : model_.coordinates()) {
      const int i = c.speed_idx;
      if (i < 0 || bounds_.fixed[at(i)] || !(bounds_.lower[i] > -kFar || bounds_.upper[i] < kFar)) continue;
      const double value = states(c.state_idx, k);
      visit(k, i, bounds_.lower[i] - value, bounds_.upper[i] - value, side_[at(k * n + i)]);
    }
}

// The step that is best within the limits, as far as the cost is a parabola. A coordinate that would leave
// its range is drawn to the limit by a stiff spring, which its neighbours in time feel through the prior
// (cutting single frames off would make the path ragged), and is let go where the spring would have to pull.
void WholeTrajectory::find_step(const MatrixXd& states) {
  const Index n = gradient_.rows();
  VectorXd next(3 * n), own(n);
  for (int round = 0; round < kRounds; ++round) {
    next.setZero();
    sweep(states, true, [&](std::int64_t k, const NodeFactor& factor) {
      step_back(factor, next, own);
      step_.col(k) = own;
      next.tail(2 * n) = next.head(2 * n).eval();
      next.head(n) = own;
    });
    bool changed = false;
    each_limited(states, [&](std::int64_t k, int i, double low, double high, std::int8_t& side) {
      const double step = step_(i, k);
      const std::int8_t now = step > high ? 1 : step < low ? -1 : 0;
      changed = changed || now != side;
      side = now;
    });
    if (!changed) break;
  }
  each_limited(states, [&](std::int64_t k, int i, double low, double high, std::int8_t&) {
    step_(i, k) = std::clamp(step_(i, k), std::min(low, 0.0), std::max(high, 0.0));
  });
}

void WholeTrajectory::add_springs(const MatrixXd& states, std::int64_t k) {
  const Index n = gradient_.rows();
  for (const auto& c : model_.coordinates()) {
    const int i = c.speed_idx;
    if (i < 0 || side_[at(k * n + i)] == 0) continue;
    const double spring = kSpring * (H_(i, i) + kPriorOfStep * prior_.precision()(i, i));
    const double limit = side_[at(k * n + i)] > 0 ? bounds_.upper[i] : bounds_.lower[i];
    H_(i, i) += spring;
    g_[i] += spring * (limit - states(c.state_idx, k));
  }
}

// Frame k becomes part of the window: its observations, and the prior that ties it to the next three.
void WholeTrajectory::load(const MatrixXd& states, std::int64_t k, bool with_right) {
  (void)rows_.visit(observations_, k, states.col(k));
  rows_.matrix(H_);
  H_.diagonal().array() += floor_;
  if (with_right) {
    g_ = -gradient_.col(k);
    add_springs(states, k);
    window_.add(0, H_, g_);
  } else {
    window_.add(0, H_, VectorXd::Zero(H_.rows()));
  }
  if (k + 3 >= frames_) return;
  (void)prior_.visit(states.col(k), states.col(k + 1), states.col(k + 2), states.col(k + 3));
  prior_.add_to(window_);
}

void WholeTrajectory::forward(const MatrixXd& states, std::int64_t first, std::int64_t last, bool keep,
                              bool with_right) {
  for (std::int64_t k = first; k < last; ++k) {
    load(states, k, with_right);
    window_.eliminate(bounds_.fixed.data(), keep ? factors_[at(k - first)] : scratch_);
  }
}

// Forward over the segments, storing the initial state of each; then backward, with the factors of each
// segment computed again (except those of the last).
void WholeTrajectory::sweep(const MatrixXd& states, bool with_right,
                            const std::function<void(std::int64_t, const NodeFactor&)>& back) {
  const std::int64_t segments = (frames_ + segment_ - 1) / segment_;
  std::vector<Window> begun;
  window_.clear();
  for (std::int64_t s = 0; s < segments; ++s) {
    if (s + 1 < segments) begun.push_back(window_);
    forward(states, s * segment_, std::min(frames_, (s + 1) * segment_), s + 1 == segments, with_right);
  }
  for (std::int64_t s = segments - 1; s >= 0; --s) {
    const std::int64_t first = s * segment_, last = std::min(frames_, first + segment_);
    if (s + 1 < segments) {
      window_ = begun[at(s)];
      forward(states, first, last, true, with_right);
    }
    for (std::int64_t k = last - 1; k >= first; --k) back(k, factors_[at(k - first)]);
  }
}

WholeTrajectory::Outcome WholeTrajectory::solve(MatrixXd& states, int max_iterations,
                                                const Progress& progress) {
  Outcome outcome;
  MatrixXd moved(states.rows(), states.cols());
  VectorXd x;
  outcome.cost = evaluate(states);
  outcome.unsettled.assign(at(frames_), 1);
  for (int i = 0; i < max_iterations; ++i) {
    if (progress && !progress(i * frames_, max_iterations * frames_)) {
      outcome.stopped = true;
      return outcome;
    }
    ++outcome.iterations;
    find_step(states);
    if (!step_.allFinite()) break;
    const VectorXd decrements = -0.5 * step_.cwiseProduct(gradient_).colwise().sum().transpose();
    const double decrement = decrements.sum();
    for (std::int64_t k = 0; k < frames_; ++k) outcome.unsettled[at(k)] = std::abs(decrements[k]) > kDone;
    double share = std::min(1.0, kLongestStep / step_.cwiseAbs().maxCoeff()), moved_cost = 0.0;
    bool better = false;
    for (int h = 0; h < kHalvings && !better; ++h, share *= 0.5) {
      moved = states;
      for (std::int64_t k = 0; k < frames_; ++k) {
        x = moved.col(k);
        model::integrate(model_, x, share * step_.col(k));
        moved.col(k) = x;
      }
      moved_cost = cost(moved);
      better = moved_cost <= outcome.cost * (1.0 + 1e-12);
    }
    if (!better) {
      outcome.converged = decrement < 1e3 * kDone;
      break;
    }
    states = moved;
    outcome.cost = evaluate(states);
    if (decrement < kDone) {
      outcome.converged = true;
      break;
    }
  }
  if (outcome.converged) std::ranges::fill(outcome.unsettled, std::uint8_t{0});
  return outcome;
}

void WholeTrajectory::covariances(const MatrixXd& states, const Visitor& visitor) {
  const Index n = gradient_.rows();
  CovarianceWindow window(n);
  sweep(states, false, [&](std::int64_t k, const NodeFactor& factor) {
    window.step_back(factor);
    if (k + 3 <= frames_) visitor(k, window.matrix());
  });
}

}  // namespace kinemark::motion::internal
