// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/internal/bundle_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/camera/parameters.h"
#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration::internal {
namespace {

using Eigen::Vector3d;
namespace ts = testing_support;

constexpr int kPoses = 10;
constexpr int kWarp = 3;

data::Rig warped(data::Rig rig) {
  for (auto& camera : rig.cameras) camera = camera::with_warp_degree(camera, kWarp);
  return rig;
}

/// A rig, what it sees of a tree and of grids, and where the tree really was.
struct Scene {
  data::Rig truth = ts::real_rig(11);
  std::vector<Eigen::Matrix3Xd> where;
  StillPoses tree = tree_observations(truth, kPoses, 11, &where);
  std::vector<GridObservations> grids = grid_observations_of(truth, 11);
  BundleOptions options;

  Scene() {
    options.warp_degree = kWarp;
    options.crosstalk = false;
  }
  /// True poses and the given rig; grids as they were meant to hang.
  [[nodiscard]] BundleState state(const data::Rig& rig, bool with_grids) const {
    BundleState out{.rig = warped(rig), .world_from_tree = {}, .cam_from_grid = {}, .grid_shift = {}};
    Eigen::Matrix3Xd own(3, tree.leds());
    for (int led = 0; led < tree.leds(); ++led) own.col(led) = tree.tree[static_cast<std::size_t>(led)];
    for (const auto& positions : where) {
      const Eigen::Matrix4d fit = Eigen::umeyama(own, positions, false);
      out.world_from_tree.push_back({fit.topLeftCorner<3, 3>(), fit.topRightCorner<3, 1>()});
    }
    if (!with_grids) return out;
    out.cam_from_grid.assign(grids.size(),
                             {Eigen::Matrix3d::Identity(), Vector3d(0, 0, grids[0].distance_m)});
    out.grid_shift.assign(grids[0].observations.size(), Eigen::Vector2d::Zero());
    return out;
  }
  /// Observations as they are without noise.
  void take_noise_away() {
    std::size_t i = 0;
    for (const auto& positions : where)
      for (int led = 0; led < tree.leds(); ++led)
        for (const auto& camera : truth.cameras)
          tree.observations[i++].counts = ts::mean_counts(camera, positions.col(led));
  }
};

const std::vector<GridObservations> kNoGrids;

TEST(BundleProblem, TruthWithoutNoiseCostsNothingAndIsLeftAlone) {
  Scene scene;
  scene.take_noise_away();
  BundleProblem problem(warped(scene.truth), scene.tree, kNoGrids, scene.options);
  const auto truth = scene.state(scene.truth, false);
  EXPECT_LT(problem.cost(truth), 1e-9);
  const auto step = problem.solve(truth);
  ASSERT_TRUE(step.solved);
  EXPECT_LT(step.decrement, 1e-9);
  EXPECT_EQ(problem.misfit(truth).observations, kPoses * 3 * 2);
  EXPECT_EQ(problem.misfit(truth).outliers, 0);
}

// All derivatives at once: those of cameras, poses, grids and their nodes, and what is eliminated of them.
TEST(BundleProblem, TheCostFallsAlongTheStepAsTheDecrementSays) {
  const Scene scene;
  for (const bool with_grids : {false, true}) {
    BundleProblem problem(warped(ts::ideal_rig()), scene.tree, with_grids ? scene.grids : kNoGrids,
                          scene.options);
    const auto start = scene.state(ts::ideal_rig(), with_grids);
    const auto step = problem.solve(start);
    ASSERT_TRUE(step.solved);
    const double h = 1e-4;
    const double slope =
        (problem.cost(problem.moved(start, step, h)) - problem.cost(problem.moved(start, step, -h))) /
        (2.0 * h);
    EXPECT_NEAR(slope, -2.0 * step.decrement, 1e-4 * step.decrement) << "grids: " << with_grids;
    EXPECT_LT(problem.cost(problem.moved(start, step, 1.0)), 0.1 * problem.cost(start))
        << "grids: " << with_grids;
  }
}

TEST(BundleProblem, StepsEndInAMinimum) {
  const Scene scene;
  BundleProblem problem(warped(ts::ideal_rig()), scene.tree, scene.grids, scene.options);
  auto state = scene.state(ts::ideal_rig(), true);
  BundleProblem::Step step;
  for (int i = 0; i < 12; ++i) {
    step = problem.solve(state);
    ASSERT_TRUE(step.solved);
    state = problem.moved(state, step, 1.0);
  }
  EXPECT_LT(step.decrement, 1e-6);
  const double least = problem.cost(state);
  Random random(5, 1);
  for (int trial = 0; trial < 10; ++trial) {
    auto away = step;
    for (Eigen::Index k = 0; k < away.shared.size(); ++k) {
      const bool own = k < static_cast<Eigen::Index>(problem.free().size());
      away.shared[k] =
          1e-3 * random.gaussian() * (own ? problem.free()[static_cast<std::size_t>(k)].sigma : 0.01);
    }
    for (auto& pose : away.poses)
      for (double& part : pose) part = 1e-4 * random.gaussian();
    EXPECT_GT(problem.cost(problem.moved(state, away, 1.0)), least);
  }
  EXPECT_NEAR(problem.misfit(state).chi2_per_dof, 1.0, 0.15);
}

TEST(BundleProblem, PosesThatTakeNoPartCostNothingAndStay) {
  const Scene scene;
  BundleProblem problem(warped(ts::ideal_rig()), scene.tree, kNoGrids, scene.options);
  const auto start = scene.state(ts::ideal_rig(), false);
  const double all = problem.cost(start);
  problem.use_poses({0, 2, 3, 7});
  const double some = problem.cost(start);
  EXPECT_LT(some, all);
  auto other = start;
  other.world_from_tree[5].translation.x() += 0.1;
  EXPECT_EQ(problem.cost(other), some);
  const auto step = problem.solve(start);
  ASSERT_EQ(step.poses.size(), 4U);
  const auto next = problem.moved(start, step, 1.0);
  EXPECT_EQ(next.world_from_tree[5].translation, start.world_from_tree[5].translation);
  EXPECT_NE(next.world_from_tree[7].translation, start.world_from_tree[7].translation);
}

TEST(BundleProblem, AnOutlierCountsByItsRootBeyondFourDeviations) {
  Scene scene;
  scene.take_noise_away();
  scene.tree.observations[13].counts[1] += 200.0;
  const auto truth = scene.state(scene.truth, false);
  BundleProblem problem(warped(scene.truth), scene.tree, kNoGrids, scene.options);
  const double misfit = problem.cost(truth);
  EXPECT_GT(misfit, 144.0);
  problem.reweigh(truth);
  EXPECT_NEAR(problem.cost(truth), std::sqrt(16.0 * misfit), 1e-6 * misfit);
  problem.reweigh(truth);
  EXPECT_NEAR(problem.cost(truth), std::sqrt(16.0 * misfit), 1e-6 * misfit)
      << "weights depend on the state alone";
  ASSERT_TRUE(problem.solve(truth).solved);
  EXPECT_EQ(problem.misfit(truth).outliers, 1);
}

TEST(BundleProblem, ARicherWarpBeginsAsThePoorerOne) {
  const Scene scene;
  BundleProblem problem(warped(ts::ideal_rig()), scene.tree, kNoGrids, scene.options);
  auto state = scene.state(ts::ideal_rig(), false);
  state = problem.moved(state, problem.solve(state), 1.0);
  const double before = problem.cost(state);
  const auto columns = problem.free().size();
  const auto richer = problem.enrich(state, kWarp + 2);
  EXPECT_NEAR(problem.cost(richer), before, 1e-9 * before);
  const int terms = data::monomial_count(2, kWarp + 2) - data::monomial_count(2, kWarp);
  EXPECT_EQ(problem.free().size(), columns + static_cast<std::size_t>(2 * 2 * terms))
      << "two cameras, x and y";
  EXPECT_TRUE(problem.solve(richer).solved);
}

TEST(BundleProblem, TheFirstCameraStaysAndCrosstalkIsFreeOnRequest) {
  Scene scene;
  const BundleProblem plain(warped(ts::ideal_rig()), scene.tree, kNoGrids, scene.options);
  scene.options.crosstalk = true;
  const BundleProblem rich(warped(ts::ideal_rig()), scene.tree, kNoGrids, scene.options);
  EXPECT_EQ(rich.free().size(), plain.free().size() + 2 * 12U);
  for (const auto& parameter : plain.free()) {
    EXPECT_GT(parameter.sigma, 0.0);
    if (parameter.camera == 0) {
      EXPECT_GE(parameter.index, data::ParameterLayout::focal) << "its pose is the world's";
    }
  }
}

TEST(BundleProblem, CovarianceIsProperAndNeverWiderThanThePriors) {
  const Scene scene;
  BundleProblem problem(warped(ts::ideal_rig()), scene.tree, kNoGrids, scene.options);
  ASSERT_TRUE(problem.solve(scene.state(scene.truth, false)).solved);
  const Eigen::MatrixXd covariance = problem.covariance();
  ASSERT_EQ(covariance.rows(), static_cast<Eigen::Index>(problem.free().size()));
  EXPECT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues()(0), 0.0);
  for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
    const double prior = problem.free()[static_cast<std::size_t>(k)].sigma;
    EXPECT_LE(std::sqrt(covariance(k, k)), prior * (1.0 + 1e-9)) << k;
  }
}

}  // namespace
}  // namespace kinemark::calibration::internal
