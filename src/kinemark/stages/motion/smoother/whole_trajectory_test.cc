// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A block on a rail has one coordinate and is linear in it: what the smoother finds is then the solution of
// one dense system, and its covariance one dense inverse.
#include "kinemark/stages/motion/smoother/internal/whole_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/smoother/internal/step_modes.h"
#include "kinemark/stages/motion/smoother/observations.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kFrames = 60;
constexpr double kNoise_m = 0.01, kStepSd_m = 0.002;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of a marker on the block: beside the rail.
Eigen::Vector3d position(int marker) { return {0.0, marker == 1 ? 0.3 : 0.0, marker == 2 ? 0.3 : 0.0}; }

model::Model rail() {
  data::ModelDescription m;
  m.name = "rail";
  m.bodies.push_back({.name = "block", .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity()});
  m.coordinates.push_back({.name = "way", .is_rotation = false, .range_min = -100.0, .range_max = 100.0});
  m.joints.push_back(
      {.name = "rail",
       .child_body_idx = 0,
       .axes = {{.is_rotation = false, .axis = Eigen::Vector3d::UnitX(), .coordinate_idx = 0}}});
  for (int i = 0; i < 3; ++i)
    m.markers.push_back({.name = std::string(1, "ABC"[i]), .body_idx = 0, .x_in_body = position(i)});
  return model::Model::compile(std::move(m)).value();
}

double truth(int f) { return 0.5 * std::sin(0.1 * f); }

/// All three markers at noisy positions along the rail; frames 20 to 29 unseen.
data::Trajectories record(std::uint64_t seed) {
  auto markers = data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 50.0, .frames = kFrames});
  Random random(seed, 12);
  for (int f = 0; f < kFrames; ++f)
    for (int m = 0; m < 3; ++m) {
      const double x = truth(f) + kNoise_m * random.gaussian();
      if (f >= 20 && f < 30) continue;
      markers.x(f, m) = position(m) + x * Eigen::Vector3d::UnitX();
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  return markers;
}

std::vector<MarkerTrust> trust() {
  return std::vector<MarkerTrust>(3, MarkerTrust{.information = 1.0 / (kNoise_m * kNoise_m)});
}
MatrixXd step_precision() { return MatrixXd::Constant(1, 1, 1.0 / (kStepSd_m * kStepSd_m)); }

/// The same by dense least squares: normal matrix and gradient, frame by frame.
struct Dense {
  MatrixXd A = MatrixXd::Zero(kFrames, kFrames);
  VectorXd b = VectorXd::Zero(kFrames);

  explicit Dense(const data::Trajectories& markers) {
    const double slope[] = {-1.0, 3.0, -3.0, 1.0};
    for (int k = 0; k + 3 < kFrames; ++k)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) A(k + i, k + j) += slope[i] * slope[j] / (kStepSd_m * kStepSd_m);
    for (int f = 0; f < kFrames; ++f)
      for (int m = 0; m < 3; ++m) {
        if (!markers.present(f, m)) continue;
        A(f, f) += 1.0 / (kNoise_m * kNoise_m);
        b[f] += markers.x(f, m).x() / (kNoise_m * kNoise_m);
      }
  }
  [[nodiscard]] MatrixXd covariance() const {
    const Eigen::LLT<MatrixXd> llt(A);
    MatrixXd C = MatrixXd::Identity(kFrames, kFrames);
    llt.solveInPlace(C);
    return C;
  }
};

struct Solved {
  VectorXd x = VectorXd::Zero(kFrames), sd = VectorXd::Zero(kFrames);
  WholeTrajectory::Outcome outcome;
};

Solved solve(const model::Model& model, const data::Trajectories& markers, const VectorXd& start,
             double low = -kInfinity, double high = kInfinity) {
  const MarkerObservations observations(markers, {0, 1, 2}, 0, trust());
  WholeTrajectory trajectory(
      model, observations, kFrames, step_precision(),
      {.fixed = {0}, .lower = VectorXd::Constant(1, low), .upper = VectorXd::Constant(1, high)});
  const int row = model.coordinates()[0].state_idx;
  MatrixXd states = MatrixXd::Zero(model.state_count(), kFrames);
  for (int f = 0; f < kFrames; ++f) states(row, f) = start[f];
  Solved out;
  out.outcome = trajectory.solve(states, 60, {});
  trajectory.covariances(states, [&](std::int64_t first, const MatrixXd& joint) {
    for (int i = 0; i < 3; ++i) out.sd[first + i] = std::sqrt(joint(i, i));
  });
  for (int f = 0; f < kFrames; ++f) out.x[f] = states(row, f);
  return out;
}

TEST(WholeTrajectory, IsBatchLeastSquaresWhereTheModelIsLinear) {
  const auto model = rail();
  const auto markers = record(1);
  const auto solved = solve(model, markers, VectorXd::Zero(kFrames));
  EXPECT_TRUE(solved.outcome.converged);
  const MatrixXd C = Dense(markers).covariance();
  const VectorXd b = Dense(markers).b;
  for (int f = 0; f < kFrames; ++f) {
    double expected = 0.0;
    for (int k = 0; k < kFrames; ++k) expected += C(f, k) * b[k];
    EXPECT_NEAR(solved.x[f], expected, 1e-6) << f;
    EXPECT_NEAR(solved.sd[f], std::sqrt(C(f, f)), 1e-5 * std::sqrt(C(f, f))) << f;
  }
  EXPECT_GT(solved.sd[25], 2.0 * solved.sd[10]) << "nothing is seen there";
}

// Motions are drawn from the prior, markers are noisy: the scatter of the errors must equal the covariance.
TEST(WholeTrajectory, CovarianceIsTheScatterOfTheErrors) {
  const auto model = rail();
  constexpr int kDraws = 100;
  VectorXd squares = VectorXd::Zero(kFrames), sd;
  Random random(3, 3);
  for (int draw = 0; draw < kDraws; ++draw) {
    VectorXd x = VectorXd::Zero(kFrames);
    for (int f = 3; f < kFrames; ++f) {
      const double step = kStepSd_m * random.gaussian();
      x[f] = 3.0 * x[f - 1] - 3.0 * x[f - 2] + x[f - 3] + step;
    }
    auto markers = record(1);
    for (int f = 0; f < kFrames; ++f)
      for (int m = 0; m < 3; ++m) {
        const double noise = kNoise_m * random.gaussian();
        if (markers.present(f, m)) markers.x(f, m).x() = x[f] + noise;
      }
    const auto solved = solve(model, markers, x);
    squares.array() += (solved.x - x).array().square();
    sd = solved.sd;
  }
  double ratio = 0.0;
  for (int f = 0; f < kFrames; ++f) {
    const double here = squares[f] / kDraws / (sd[f] * sd[f]);
    EXPECT_GT(here, 0.43) << f;  // 4 standard errors of a variance from 100 draws
    EXPECT_LT(here, 1.57) << f;
    ratio += here / kFrames;
  }
  EXPECT_NEAR(ratio, 1.0, 0.17);
}

// At a minimum under limits the slope of the cost is zero where the block is free and points outwards where
// it rests against a limit.
TEST(WholeTrajectory, LimitsAreInequalities) {
  const auto model = rail();
  const auto markers = record(2);
  const double high = 0.4, low = -0.35;
  const auto solved = solve(model, markers, VectorXd::Zero(kFrames), low, high);
  const Dense dense(markers);
  int at_high = 0, at_low = 0, free = 0;
  for (int f = 0; f < kFrames; ++f) {
    double slope = -dense.b[f];
    for (int k = 0; k < kFrames; ++k) slope += dense.A(f, k) * solved.x[k];
    const double scaled = slope * solved.sd[f];  // what a move of one deviation would cost
    ASSERT_LE(solved.x[f], high + 1e-12);
    ASSERT_GE(solved.x[f], low - 1e-12);
    if (solved.x[f] > high - 1e-9) {
      EXPECT_LT(scaled, 0.05) << f;
      ++at_high;
    } else if (solved.x[f] < low + 1e-9) {
      EXPECT_GT(scaled, -0.05) << f;
      ++at_low;
    } else {
      EXPECT_NEAR(scaled, 0.0, 0.05) << f;
      ++free;
    }
  }
  EXPECT_GT(at_high, 3);
  EXPECT_GT(at_low, 0);
  EXPECT_GT(free, 20);
}

TEST(WholeTrajectory, AFixedSpeedNeverMoves) {
  const auto model = rail();
  const auto markers = record(4);
  const MarkerObservations observations(markers, {0, 1, 2}, 0, trust());
  WholeTrajectory trajectory(
      model, observations, kFrames, step_precision(),
      {.fixed = {1}, .lower = VectorXd::Constant(1, -kInfinity), .upper = VectorXd::Constant(1, kInfinity)});
  MatrixXd states = MatrixXd::Constant(model.state_count(), kFrames, 0.125);
  const MatrixXd before = states;
  (void)trajectory.solve(states, 5, {});
  EXPECT_EQ(states, before);
}

TEST(WholeTrajectory, ThreeFramesAreNoTrajectory) {
  const auto model = rail();
  const auto markers = record(1);
  const MarkerObservations observations(markers, {0, 1, 2}, 0, trust());
  EXPECT_THROW(WholeTrajectory(model, observations, 3, step_precision(), {}), ContractError);
}

TEST(StepModes, KeepWhatIsGivenWhereNextToNothingIsWhiteNoise) {
  const auto model = rail();
  const auto markers = record(3);
  const MarkerObservations observations(markers, {0, 1, 2}, 0, trust());
  const double given = 1e-3;  // far more than the movement has
  SinglePaths paths{.step_variance = VectorXd::Constant(1, given),
                    .value = MatrixXd::Zero(1, kFrames),
                    .doubt = MatrixXd::Zero(1, kFrames)};
  for (int f = 0; f < kFrames; ++f) {
    const bool seen = f < 20 || f >= 30;
    paths.value(0, f) = seen ? markers.x(f, 0).x() : truth(f);
    if (!seen) paths.doubt(0, f) = kNoise_m * kNoise_m;
  }
  const auto white = step_modes(model, observations, {0}, paths.value, paths, 1.0);
  EXPECT_GT(white.precision(0, 0), 5.0 / given) << "the nearest curve is smoother than what was given";
  EXPECT_GT(white.spread.maxCoeff(), 0.0);
  const auto slow = step_modes(model, observations, {0}, paths.value, paths, 101.0);
  EXPECT_DOUBLE_EQ(slow.precision(0, 0), 1.0 / given);
  EXPECT_TRUE(slow.spread.isZero(0.0));
}

}  // namespace
}  // namespace kinemark::motion::internal
