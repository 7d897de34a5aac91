// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/scatter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_leg::leg;

constexpr double kSd = 0.01;

/// A sine of this amplitude about 0.4 rad, and noise.
VectorXd angles(Index frames, double amplitude, std::uint64_t seed, double noise = kSd) {
  Random random(seed, 2);
  VectorXd out(frames);
  for (Index f = 0; f < frames; ++f)
    out[f] = 0.4 + amplitude * std::sin(0.17 * static_cast<double>(f)) + noise * random.gaussian();
  return out;
}

VectorXd known(Index frames) { return VectorXd::Constant(frames, kSd * kSd); }

TEST(MeasureScatter, a_joint_that_keeps_still_has_no_motion) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scatter s = measure_scatter(angles(400, 0.0, seed), known(400));
    EXPECT_EQ(s.motion, 0.0) << seed;
    EXPECT_NEAR(s.mean, 0.4, 5.0 * kSd / 20.0);
  }
}

TEST(MeasureScatter, drawn_together_the_angles_scatter_as_the_joint_moved) {
  for (const double amplitude : {0.01, 0.03, 0.3}) {
    double square = 0.0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const VectorXd a = angles(2000, amplitude, seed);
      const Scatter s = measure_scatter(a, known(2000));
      square += (s.motion * (a.array() - s.mean)).square().mean() / 20.0;
    }
    EXPECT_NEAR(std::sqrt(square), amplitude / std::sqrt(2.0), 0.02 * amplitude) << amplitude;
  }
}

TEST(MeasureScatter, wide_motion_stays_as_it_is) {
  EXPECT_GT(measure_scatter(angles(100, 0.5, 1), known(100)).motion, 0.999);
}

TEST(MeasureScatter, uncertain_samples_count_by_their_uncertainty) {
  VectorXd a = angles(400, 0.0, 3), v = known(400);
  Random random(9, 9);
  for (Index f = 0; f < 400; f += 4) {
    a[f] += 0.2 * random.gaussian();
    v[f] += 0.04;
  }
  EXPECT_EQ(measure_scatter(a, v).motion, 0.0);
  EXPECT_GT(measure_scatter(a, known(400)).motion, 0.9);
}

TEST(MeasureScatter, samples_of_which_nothing_is_known_do_not_count) {
  VectorXd a = angles(100, 0.3, 4), v = known(100);
  const Scatter all = measure_scatter(a.head(60), v.head(60));
  for (Index f = 60; f < 80; ++f) v[f] = std::numeric_limits<double>::infinity();
  for (Index f = 80; f < 100; ++f) v[f] = 7.0;
  a.tail(40).setConstant(1e6);
  const Scatter some = measure_scatter(a, v);
  EXPECT_EQ(some.mean, all.mean);
  EXPECT_EQ(some.motion, all.motion);
}

TEST(MeasureScatter, nothing_can_be_said_of_fewer_than_two_samples) {
  EXPECT_EQ(measure_scatter(VectorXd(0), VectorXd(0)).motion, 1.0);
  EXPECT_EQ(measure_scatter(VectorXd::Constant(1, 0.3), known(1)).motion, 1.0);
  EXPECT_EQ(measure_scatter(angles(50, 0.1, 1), VectorXd::Constant(50, 2.0)).motion, 1.0);
}

struct Measured {
  data::Trajectories recording;
  std::vector<GeometryParameter> list = testing_leg::sizes_and_positions(leg(), {});
  testing_leg::Solved solved;
  GeometryLayout layout;

  explicit Measured(const testing_leg::Recording& how)
      : recording(testing_leg::record(leg(), how)),
        solved(testing_leg::solve(leg(), recording)),
        layout(solved.problem, leg(), list) {}
};

TEST(PostureVariances, are_those_of_least_squares) {
  Measured m({.frames = 4, .noise_sd_m = 0.001});
  for (std::int64_t k = 0; k < m.recording.markers(); ++k) m.recording.set_missing(3, k);
  const MatrixXd ours = posture_variances(m.solved.problem, m.layout, m.recording, m.solved.states, 1);
  model::Workspace w(m.solved.problem.model);
  MatrixXd J;
  for (Index f = 0; f < 3; ++f) {
    model::kinematics(m.solved.problem.model, w, m.solved.states.col(f));
    model::marker_jacobian(m.solved.problem.model, w, J);
    const VectorXd theirs = (J.transpose() * J).inverse().diagonal();
    for (Index i = 0; i < theirs.size(); ++i) EXPECT_NEAR(ours(i, f), theirs[i], 1e-6 * theirs[i]);
  }
  EXPECT_EQ(ours.col(3).minCoeff(), std::numeric_limits<double>::infinity());
}

TEST(Quiet, a_still_knee_gets_one_angle_and_a_moving_hip_keeps_its_own) {
  constexpr double noise = 0.002;
  const Measured m({.frames = 120, .noise_sd_m = noise, .knee_still = true});
  const auto& problem = m.solved.problem;
  const Quiet quiet = Quiet::measure(problem, m.layout, m.recording, m.solved.states, noise, 1);
  const MatrixXd states = quiet.apply(problem, m.solved.states);
  const auto row = [&](const char* name) {
    return problem.model
        .coordinates()[static_cast<std::size_t>(problem.model.description().find_coordinate(name))]
        .state_idx;
  };
  for (const char* name : {"knee_angle", "ankle_angle"}) {
    EXPECT_EQ(quiet.motion()[problem.model.description().find_coordinate(name)], 0.0) << name;
    EXPECT_LT((states.row(row(name)).array() + 0.3).abs().maxCoeff(), 0.005) << name;
    EXPECT_GT((m.solved.states.row(row(name)).array() + 0.3).abs().maxCoeff(), 0.01) << name;
  }
  EXPECT_GT(quiet.motion()[problem.model.description().find_coordinate("hip_flexion")], 0.99);
  EXPECT_LT((states.row(row("hip_flexion")) - m.solved.states.row(row("hip_flexion"))).norm(),
            1e-2 * m.solved.states.row(row("hip_flexion")).norm());
  EXPECT_EQ(states.topRows(7), m.solved.states.topRows(7));  // the free root
}

TEST(Quiet, without_noise_everything_stays) {
  const Measured m({.frames = 30});
  const Quiet quiet = Quiet::measure(m.solved.problem, m.layout, m.recording, m.solved.states, 1e-9, 1);
  EXPECT_LT((quiet.apply(m.solved.problem, m.solved.states) - m.solved.states).norm(), 1e-9);
}

}  // namespace
}  // namespace kinemark::motion::internal
