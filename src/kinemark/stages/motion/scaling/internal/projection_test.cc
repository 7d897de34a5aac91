// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/projection.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_leg::leg;

constexpr std::int64_t kFrames = 5;
constexpr double kNoise_m = 0.002;

/// Geometry and the postures of all frames as one long vector, residuals and their derivatives by
/// differences: independent of Schur complements and Jacobians.
class BruteForce {
 public:
  BruteForce(data::ModelDescription base, std::vector<GeometryParameter> list,
             const data::Trajectories& recording, MatrixXd states)
      : base_(std::move(base)),
        list_(std::move(list)),
        recording_(recording),
        states_(std::move(states)),
        x(VectorXd::Zero(P())) {}

  [[nodiscard]] Index P() const { return static_cast<Index>(list_.size()); }
  [[nodiscard]] Index speeds() const { return model::Model::compile(base_)->speed_count(); }

  [[nodiscard]] VectorXd residual(const VectorXd& step) const {
    const auto m = model::Model::compile(apply_geometry(base_, list_, x + step.head(P()))).value();
    model::Workspace w(m);
    VectorXd r(3 * m.marker_count() * kFrames);
    for (Index f = 0; f < kFrames; ++f) {
      VectorXd state = states_.col(f);
      model::integrate(m, state, step.segment(P() + f * m.speed_count(), m.speed_count()));
      model::kinematics(m, w, state);
      for (Index i = 0; i < m.marker_count(); ++i)
        r.segment<3>(3 * (f * m.marker_count() + i)) = recording_.x(f, i) - w.marker.col(i);
    }
    return r;
  }

  /// d(model)/d(step) at the present point.
  [[nodiscard]] MatrixXd slope() const {
    constexpr double h = 1e-5;
    VectorXd step = VectorXd::Zero(P() + kFrames * speeds());
    MatrixXd A(residual(step).size(), step.size());
    for (Index k = 0; k < step.size(); ++k) {
      step[k] = h;
      A.col(k) = -residual(step);
      step[k] = -h;
      A.col(k) = (A.col(k) + residual(step)) / (2.0 * h);
      step[k] = 0.0;
    }
    return A;
  }

  /// Damped Gauss-Newton over everything at once, with the weights of the geometry's prior.
  void minimise(const VectorXd& prior) {
    const auto cost = [&](const VectorXd& step) {
      return residual(step).squaredNorm() + prior.dot((x + step.head(P())).cwiseAbs2());
    };
    const VectorXd none = VectorXd::Zero(P() + kFrames * speeds());
    double damping = 1e-3;
    for (int i = 0; i < 60; ++i) {
      const MatrixXd A = slope();
      MatrixXd H = A.transpose() * A;
      VectorXd g = A.transpose() * residual(none);
      H.diagonal().head(P()) += prior;
      g.head(P()) -= prior.cwiseProduct(x);
      if (g.norm() < 1e-11) break;
      H.diagonal() *= 1.0 + damping;
      const VectorXd step = H.ldlt().solve(g);
      if (cost(step) > cost(none)) {
        damping *= 10.0;
        continue;
      }
      damping *= 0.1;
      const auto m = model::Model::compile(base_).value();
      x += step.head(P());
      for (Index f = 0; f < kFrames; ++f) {
        VectorXd state = states_.col(f);
        model::integrate(m, state, step.segment(P() + f * m.speed_count(), m.speed_count()));
        states_.col(f) = state;
      }
    }
  }

 private:
  data::ModelDescription base_;
  std::vector<GeometryParameter> list_;
  const data::Trajectories& recording_;
  MatrixXd states_;

 public:
  VectorXd x;
};

struct Case {
  std::vector<GeometryParameter> list = testing_leg::sizes_and_positions(leg(), {"THI", "TOE"});
  data::Trajectories recording;
  testing_leg::Solved solved;
  Projection projection;
  VectorXd prior;

  explicit Case(double noise_m = kNoise_m)
      : recording(make(list, noise_m)),
        solved(testing_leg::solve(leg(), recording)),
        projection(leg(), list, solved.problem, solved.options, recording, 1),
        prior(static_cast<Index>(list.size())) {
    for (Index k = 0; k < prior.size(); ++k)
      prior[k] = std::pow(kNoise_m / list[static_cast<std::size_t>(k)].prior_sd, 2);
  }
  static data::Trajectories make(const std::vector<GeometryParameter>& list, double noise_m) {
    VectorXd change = VectorXd::Constant(static_cast<Index>(list.size()), 0.003);
    for (Index k = 0; k < change.size(); ++k)
      if (list[static_cast<std::size_t>(k)].kind == ParameterKind::body_scale)
        change[k] = k % 2 == 0 ? 0.05 : -0.04;
    // Frames far apart, so that five of them move every joint.
    auto all = testing_leg::record(apply_geometry(leg(), list, change),
                                   {.frames = 40 * kFrames, .noise_sd_m = noise_m, .seed = 5});
    auto out = data::Trajectories::all_missing(all.names, {.rate_hz = 1.5, .t0_s = 0.0, .frames = kFrames});
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (std::int64_t m = 0; m < all.markers(); ++m) {
        out.x(f, m) = all.x(40 * f, m);
        out.state[out.index(f, m)] = data::SampleState::measured;
      }
    return out;
  }
};

TEST(Projection, its_normal_equations_are_the_joint_ones_with_the_postures_eliminated) {
  Case c;
  MatrixXd states = c.solved.states;
  const VectorXd x = VectorXd::Constant(c.prior.size(), 0.002);
  const auto sums = c.projection.solve(x, states);
  BruteForce oracle(leg(), c.list, c.recording, states);
  oracle.x = x;
  const MatrixXd A = oracle.slope();
  const Index P = oracle.P(), rest = A.cols() - P;
  const MatrixXd H = A.transpose() * A;
  const MatrixXd S =
      H.topLeftCorner(P, P) -
      H.topRightCorner(P, rest) * H.bottomRightCorner(rest, rest).ldlt().solve(H.bottomLeftCorner(rest, P));
  const MatrixXd ours = sums.normal.S.selfadjointView<Eigen::Lower>();
  EXPECT_LT((ours - S).norm(), 1e-5 * S.norm());
  const VectorXd r = oracle.residual(VectorXd::Zero(A.cols()));
  EXPECT_NEAR(sums.normal.squares, r.squaredNorm(), 1e-12);
  EXPECT_LT((A.rightCols(rest).transpose() * r).norm(), 1e-6);  // the postures are at their best
  EXPECT_LT((sums.normal.g - A.leftCols(P).transpose() * r).norm(), 1e-6 * sums.normal.g.norm());
}

TEST(Projection, its_minimum_is_that_of_a_brute_force_solve_of_everything) {
  Case c;
  MatrixXd states = c.solved.states;
  VectorXd x = VectorXd::Zero(c.prior.size());
  for (int i = 0; i < 60; ++i) {
    const auto sums = c.projection.solve(x, states);
    MatrixXd S = sums.normal.S.selfadjointView<Eigen::Lower>();
    S.diagonal() += c.prior;
    x += S.llt().solve(sums.normal.g - c.prior.cwiseProduct(x));
  }
  BruteForce oracle(leg(), c.list, c.recording, c.solved.states);
  oracle.minimise(c.prior);
  EXPECT_GT(oracle.x.norm(), 0.05);
  EXPECT_LT((x - oracle.x).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Projection, a_step_costs_what_its_gradient_says) {
  Case c;
  MatrixXd states = c.solved.states;
  VectorXd x = VectorXd::Zero(c.prior.size());
  const auto here = c.projection.solve(x, states);
  constexpr double h = 1e-5;
  for (Index k = 0; k < x.size(); ++k) {
    x[k] = h;
    const double up = c.projection.solve(x, states).cost;
    x[k] = -h;
    const double down = c.projection.solve(x, states).cost;
    x[k] = 0.0;
    EXPECT_NEAR((down - up) / (2.0 * h), 2.0 * here.normal.g[k], 1e-4 * here.normal.g.norm())
        << c.list[static_cast<std::size_t>(k)].name;
  }
}

TEST(Projection, sums_at_the_best_postures_are_those_of_the_solve) {
  Case c;
  MatrixXd states = c.solved.states;
  const auto solved = c.projection.solve(VectorXd::Zero(c.prior.size()), states);
  const auto again = c.projection.sums_at(states, states);
  EXPECT_EQ(again.S, solved.normal.S);
  EXPECT_EQ(again.g, solved.normal.g);
  EXPECT_EQ(again.seen, solved.normal.seen);
}

TEST(Projection, twice_the_frames_are_twice_the_sums) {
  Case c;
  auto twice = data::Trajectories::all_missing(c.recording.names,
                                               {.rate_hz = 1.5, .t0_s = 0.0, .frames = 2 * kFrames});
  MatrixXd states(c.solved.states.rows(), 2 * kFrames);
  for (std::int64_t f = 0; f < 2 * kFrames; ++f) {
    states.col(f) = c.solved.states.col(f % kFrames);
    for (std::int64_t m = 0; m < twice.markers(); ++m) {
      twice.x(f, m) = c.recording.x(f % kFrames, m);
      twice.state[twice.index(f, m)] = data::SampleState::measured;
    }
  }
  const auto solved = testing_leg::solve(leg(), twice);
  Projection projection(leg(), c.list, solved.problem, solved.options, twice, 1);
  const VectorXd x = VectorXd::Zero(c.prior.size());
  const auto both = projection.solve(x, states);
  MatrixXd single = c.solved.states;
  const auto one = c.projection.solve(x, single);
  EXPECT_LT((both.normal.S - 2.0 * one.normal.S).norm(), 1e-12 * both.normal.S.norm());
  EXPECT_LT((both.normal.g - 2.0 * one.normal.g).norm(), 1e-9 * both.normal.g.norm());
  EXPECT_EQ(both.moved_speeds, 2 * one.moved_speeds);
  projection.set_frames(2);
  EXPECT_EQ(projection.solve(x, states).normal.seen, one.normal.seen);
}

TEST(Projection, a_geometry_that_is_no_model_costs_nan_and_changes_nothing) {
  Case c;
  MatrixXd states = c.solved.states;
  VectorXd x = VectorXd::Zero(c.prior.size());
  x[0] = std::nan("");
  EXPECT_TRUE(std::isnan(c.projection.solve(x, states).cost));
  EXPECT_EQ(states, c.solved.states);
}

TEST(Projection, a_frame_that_nobody_saw_adds_nothing) {
  Case c;
  MatrixXd states = c.solved.states;
  const VectorXd x = VectorXd::Zero(c.prior.size());
  for (std::int64_t m = 0; m < c.recording.markers(); ++m) c.recording.set_missing(2, m);
  const auto sums = c.projection.solve(x, states);
  EXPECT_EQ(sums.normal.seen, (kFrames - 1) * c.recording.markers());
  EXPECT_EQ(states.col(2), c.solved.states.col(2));
  EXPECT_TRUE(sums.normal.S.allFinite());
}

}  // namespace
}  // namespace kinemark::motion::internal
