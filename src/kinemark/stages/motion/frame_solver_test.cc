// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/frame_solver.h"

#include <gmock/gmock.h>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/start.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::VectorXd;
using testing_body::coordinates;
using testing_body::description;
using testing_body::record;

/// One frame of the moving body, ready to be solved.
struct Frame {
  explicit Frame(IkOptions o = {}, data::ModelDescription d = description(), double noise_sd_m = 0.0)
      : options(std::move(o)),
        body(model::Model::compile(std::move(d)).value()),
        markers(record(model::Model::compile(description()).value(), 3, noise_sd_m, 5)),
        problem(make_problem(body, markers, options).value()),
        solver(problem, options),
        y(3, problem.model.marker_count()),
        weight(problem.model.marker_count()),
        truth(model::state_from_coordinates(problem.model, coordinates(problem.model, 1))) {
    problem.observe(markers, 1, y, weight);
  }
  VectorXd near_truth(double by, std::uint64_t seed) const {
    Random random(seed, 3);
    VectorXd move(problem.model.speed_count()), x = truth;
    for (double& v : move) v = random.uniform(-by, by);
    model::integrate(problem.model, x, move);
    return x;
  }
  double distance(const VectorXd& x) const {
    VectorXd d(problem.model.speed_count());
    model::difference(problem.model, truth, x, d);
    return d.norm();
  }

  IkOptions options;
  model::Model body;
  data::Trajectories markers;
  Problem problem;
  FrameSolver solver;
  Eigen::Matrix3Xd y;
  VectorXd weight, truth;
};

TEST(FrameSolver, ConvergesToTheTruthFromNearby) {
  Frame frame;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    VectorXd x = frame.near_truth(0.3, seed);
    const auto outcome = frame.solver.solve(frame.y, frame.weight, 1, x);
    EXPECT_TRUE(outcome.converged) << seed;
    EXPECT_LT(frame.distance(x), 1e-8) << seed;
    EXPECT_LT(outcome.cost, 1e-18);
  }
}

TEST(FrameSolver, NoStepFromTheSolutionLowersTheCost) {
  Frame frame({}, description(), 0.005);
  VectorXd x = frame.near_truth(0.1, 1);
  const double cost = frame.solver.solve(frame.y, frame.weight, 1, x).cost;
  EXPECT_NEAR(frame.solver.square_cost(frame.y, frame.weight, 1, x), cost, 1e-15);
  for (int k = 0; k < frame.problem.model.speed_count(); ++k)
    for (const double step : {-1e-4, 1e-4}) {
      VectorXd move = VectorXd::Zero(frame.problem.model.speed_count()), other = x;
      move[k] = step;
      model::integrate(frame.problem.model, other, move);
      EXPECT_GT(frame.solver.square_cost(frame.y, frame.weight, 1, other), cost) << k << ' ' << step;
    }
}

TEST(FrameSolver, CostIsTheMeanOfTheSquaresWhateverTheScaleOfTheWeights) {
  Frame frame({}, description(), 0.005);
  VectorXd x = frame.truth;
  const double cost = frame.solver.square_cost(frame.y, frame.weight, 1, x);
  EXPECT_NEAR(frame.solver.square_cost(frame.y, 10.0 * frame.weight, 1, x), cost, 1e-15);
  model::Workspace w(frame.problem.model);
  model::kinematics(frame.problem.model, w, x);
  EXPECT_NEAR(cost, (frame.y - w.marker).squaredNorm() / 14.0, 1e-15);
}

TEST(FrameSolver, ALimitedCoordinateStopsAtItsLimit) {
  auto tight = description();
  const double knee = coordinates(model::Model::compile(description()).value(), 1)[11];
  tight.coordinates[11].range_max = knee - 0.2;
  Frame frame({}, tight);
  VectorXd x = frame.problem.model.default_state();
  frame.solver.solve(frame.y, frame.weight, 1, x);
  const auto& coordinate = frame.problem.model.coordinates()[11];
  EXPECT_NEAR(x[coordinate.state_idx], knee - 0.2, 1e-9);
}

TEST(FrameSolver, ALockedCoordinateDoesNotMove) {
  auto locked = description();
  locked.coordinates[9].locked = true;
  locked.coordinates[9].default_value = 0.123;
  Frame frame({}, locked);
  VectorXd x = frame.problem.model.default_state();
  frame.solver.solve(frame.y, frame.weight, 1, x);
  EXPECT_EQ(x[frame.problem.model.coordinates()[9].state_idx], 0.123);
}

TEST(FrameSolver, ATaskMovesItsCoordinateAndAStrongerOneMore) {
  double before = 0.0;
  for (const double weight : {1e-4, 1e-2, 1.0}) {
    IkOptions options;
    options.coordinate_tasks = {{.coordinate = "elbow", .weight = weight, .value = 2.0}};
    Frame frame(options);
    VectorXd x = frame.truth;
    frame.solver.solve(frame.y, frame.weight, 1, x);
    const double elbow = x[frame.problem.model.coordinates()[9].state_idx];
    EXPECT_GT(elbow, before) << weight;
    before = elbow;
  }
  EXPECT_NEAR(before, 2.0, 0.05);
}

TEST(FrameSolver, ATaskOnAnAngleOfTheFreeRootWorksToo) {
  IkOptions options;
  options.coordinate_tasks = {{.coordinate = "tilt", .weight = 100.0, .value = 0.0}};
  Frame frame(options);
  VectorXd x = frame.truth, q;
  frame.solver.solve(frame.y, frame.weight, 1, x);
  model::coordinates_from_state(frame.problem.model, x, coordinates(frame.problem.model, 1), q);
  EXPECT_NEAR(q[0], 0.0, 0.01);
}

TEST(FrameSolver, NothingSeenLeavesThePoseAlone) {
  Frame frame;
  const VectorXd nothing = VectorXd::Zero(frame.weight.size());
  VectorXd x = frame.near_truth(0.2, 2);
  const VectorXd before = x;
  frame.solver.solve(frame.y, nothing, 1, x);
  EXPECT_LT((x - before).norm(), 1e-6);
  EXPECT_TRUE(x.allFinite());
}

TEST(FindStart, FindsThePoseFromFarAway) {
  Frame frame;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto options = frame.options;
    options.seed = seed;
    VectorXd x = frame.near_truth(1.2, seed);
    find_start(frame.problem, options, frame.solver, frame.y, frame.weight, 1, 60, x);
    EXPECT_LT(frame.distance(x), 1e-6) << seed;
  }
}

TEST(FindStart, OneSeedOneAnswer) {
  Frame a({}, description(), 0.01), b({}, description(), 0.01);
  VectorXd x = a.near_truth(2.0, 9), z = x;
  find_start(a.problem, a.options, a.solver, a.y, a.weight, 1, 10, x);
  find_start(b.problem, b.options, b.solver, b.y, b.weight, 1, 10, z);
  EXPECT_EQ(x, z);
}

TEST(FindStart, LeavesOutWhatIsNotSeen) {
  Frame frame;
  VectorXd weight = frame.weight;
  Eigen::Matrix3Xd y = frame.y;
  weight[0] = weight[6] = 0.0;
  y.col(0).setConstant(1e3);  // must not be read
  VectorXd x = frame.problem.model.default_state();
  find_start(frame.problem, frame.options, frame.solver, y, weight, 1, 60, x);
  EXPECT_LT(frame.distance(x), 1e-6);
}

}  // namespace
}  // namespace kinemark::motion::internal
