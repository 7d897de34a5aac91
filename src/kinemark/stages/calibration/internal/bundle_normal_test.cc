// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The normal equations against the cost itself: without noise the cost is the quadratic form that they hold.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/camera/parameters.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/calibration/internal/bundle_problem.h"
#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace ts = testing_support;

/// A rig that sees a tree in a few poses without noise, and the state that explains all of it.
struct ExactScene {
  data::Rig rig = ts::real_rig(5);
  std::vector<Eigen::Matrix3Xd> positions;
  StillPoses tree;
  std::vector<GridObservations> no_grids;
  BundleOptions options;
  BundleState truth;

  ExactScene() {
    for (auto& camera : rig.cameras) camera = camera::with_warp_degree(camera, 1);
    options.warp_degree = 1;
    options.crosstalk = false;
    tree = tree_observations(rig, 5, 5, &positions);
    truth.rig = rig;
    std::size_t i = 0;
    Eigen::Matrix3Xd own(3, tree.leds());
    for (int led = 0; led < tree.leds(); ++led) own.col(led) = tree.tree[static_cast<std::size_t>(led)];
    for (const auto& x : positions) {
      const Eigen::Matrix4d fit = Eigen::umeyama(own, x, false);
      truth.world_from_tree.push_back({fit.topLeftCorner<3, 3>(), fit.topRightCorner<3, 1>()});
      for (int led = 0; led < tree.leds(); ++led)
        for (const auto& camera : rig.cameras)
          tree.observations[i++].counts = ts::mean_counts(camera, x.col(led));
    }
  }
};

/// A change of the free parameters and of nothing else, a part of their priors.
BundleProblem::Step change_of(const BundleProblem& problem, double size, std::uint64_t seed) {
  BundleProblem::Step step;
  step.solved = true;
  step.shared.setZero(static_cast<Eigen::Index>(problem.free().size()));
  Random random(seed, 2);
  for (Eigen::Index k = 0; k < step.shared.size(); ++k)
    step.shared[k] = size * problem.free()[static_cast<std::size_t>(k)].sigma * random.gaussian();
  step.poses.assign(problem.poses().size(), Eigen::Matrix<double, 6, 1>::Zero());
  return step;
}

class BundleNormal : public ::testing::Test {
 protected:
  BundleNormal() : problem(scene.rig, scene.tree, scene.no_grids, scene.options) {
    solved = problem.solve(scene.truth).solved;
  }
  [[nodiscard]] double cost_after(const BundleProblem::Step& step) const {
    return problem.cost(problem.moved(scene.truth, step, 1.0));
  }
  /// The poses that follow a change of the parameters.
  void follow(BundleProblem::Step& step) const {
    for (std::size_t p = 0; p < step.poses.size(); ++p) step.poses[p] = problem.pose_by_free(p) * step.shared;
  }

  ExactScene scene;
  BundleProblem problem;
  bool solved = false;
};

TEST_F(BundleNormal, TheCovarianceIsThatOfTheCostWithPosesThatFollow) {
  ASSERT_TRUE(solved);
  const MatrixXd information = problem.covariance().inverse();
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    auto step = change_of(problem, 1e-5, seed);
    follow(step);
    const double predicted = step.shared.dot(information * step.shared);
    EXPECT_NEAR(cost_after(step) / predicted, 1.0, 0.01) << seed;
  }
}

TEST_F(BundleNormal, NoOtherPosesGoBetterWithTheParameters) {
  ASSERT_TRUE(solved);
  Random random(3, 3);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    auto step = change_of(problem, 1e-4, seed);
    const double with_poses_that_stay = cost_after(step);
    follow(step);
    const double least = cost_after(step);
    EXPECT_LT(least, with_poses_that_stay);
    double largest = 0.0;
    for (const auto& pose : step.poses) largest = std::max(largest, pose.norm());
    for (int trial = 0; trial < 5; ++trial) {
      auto other = step;
      for (auto& pose : other.poses)
        for (double& part : pose) part += 0.2 * largest * random.gaussian();
      EXPECT_GT(cost_after(other), least) << seed;
    }
  }
}

TEST_F(BundleNormal, OneStepGoesBackToTheTruth) {
  Random random(4, 4);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto away = change_of(problem, 1e-3, seed);
    for (auto& pose : away.poses)
      for (double& part : pose) part = 1e-4 * random.gaussian();
    const BundleState start = problem.moved(scene.truth, away, 1.0);
    const double before = problem.cost(start);
    const auto step = problem.solve(start);
    ASSERT_TRUE(step.solved);
    EXPECT_NEAR(step.decrement / before, 1.0, 0.05) << "all of the cost is to be gained";
    EXPECT_LT(problem.cost(problem.moved(start, step, 1.0)), 0.02 * before) << seed;
  }
}

TEST_F(BundleNormal, MoreObservationsLeaveLessOpen) {
  ASSERT_TRUE(solved);
  const VectorXd all = problem.covariance().diagonal();
  BundleProblem fewer(scene.rig, scene.tree, scene.no_grids, scene.options);
  fewer.use_poses({0, 2, 4});
  ASSERT_TRUE(fewer.solve(scene.truth).solved);
  const VectorXd some = fewer.covariance().diagonal();
  ASSERT_EQ(all.size(), some.size());
  EXPECT_TRUE((some.array() >= all.array() * (1.0 - 1e-9)).all());
  EXPECT_GT((some.array() / all.array()).maxCoeff(), 1.2);
}

TEST_F(BundleNormal, ObservationsTwiceAsSureQuarterTheirPartOfTheCost) {
  auto step = change_of(problem, 1e-3, 9);
  const double rough = cost_after(step);
  ExactScene surer;
  for (auto& seen : surer.tree.observations) seen.variance /= 4.0;
  const BundleProblem sure(surer.rig, surer.tree, surer.no_grids, surer.options);
  double priors = 0.0;
  for (Eigen::Index k = 0; k < step.shared.size(); ++k)
    priors += std::pow(step.shared[k] / problem.free()[static_cast<std::size_t>(k)].sigma, 2);
  EXPECT_NEAR((sure.cost(sure.moved(surer.truth, step, 1.0)) - priors) / (rough - priors), 4.0, 1e-6);
}

TEST_F(BundleNormal, APoseThatOneCameraSeesAloneIsStillSolved) {
  ExactScene lonely;
  for (int led = 0; led < lonely.tree.leds(); ++led)
    for (int c = 1; c < lonely.tree.cameras; ++c)
      lonely.tree.observations[static_cast<std::size_t>(led * lonely.tree.cameras + c)] = {};
  BundleProblem alone(lonely.rig, lonely.tree, lonely.no_grids, lonely.options);
  const auto step = alone.solve(lonely.truth);
  ASSERT_TRUE(step.solved);
  EXPECT_TRUE(alone.covariance().allFinite());
  EXPECT_LT(step.decrement, 1e-9);
}

}  // namespace
}  // namespace kinemark::calibration::internal
