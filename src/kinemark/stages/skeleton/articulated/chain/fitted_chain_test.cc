// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

/// A covariance of any shape.
Eigen::MatrixXd any_covariance(Eigen::Index n) {
  Random random(3, 1);
  Eigen::MatrixXd root(n, n);
  for (double& value : root.reshaped()) value = 1e-3 * random.gaussian();
  return root * root.transpose();
}

TEST(FittedChain, LengthsAreThoseBetweenJointsOfOneSegment) {
  const RandomChain limb = make_random_chain({.segments = 4, .frames = 1});
  FittedChain fit = known_geometry(limb, 0.001);
  auto lengths = fit.lengths();
  ASSERT_EQ(lengths.size(), 2U);
  EXPECT_NEAR(lengths[0].length_m, 0.150, 1e-12);
  EXPECT_EQ(lengths[0].sd_m, 0.0);
  EXPECT_EQ(lengths[1].joint_a, 1);
  EXPECT_EQ(lengths[1].joint_b, 2);
  EXPECT_LT((lengths[0].direction - Vector3d::UnitZ()).norm(), 1e-12);
  // First order: the SD is that of the length's change with the parameters.
  const auto n = fit.geometry_covariance.rows();
  fit.geometry_covariance = any_covariance(n);
  lengths = fit.lengths();
  Eigen::VectorXd slope(n);
  for (Eigen::Index g = 0; g < n; ++g) {
    FittedChain moved = fit;
    moved.chain.move_geometry(1e-6 * Eigen::VectorXd::Unit(n, g));
    slope[g] = (moved.lengths()[1].length_m - lengths[1].length_m) / 1e-6;
  }
  EXPECT_NEAR(lengths[1].sd_m, std::sqrt(slope.dot(fit.geometry_covariance * slope)), 1e-6);
}

// Rotating or shifting a whole segment moves its axes with it: no part of the joint's uncertainty in them.
TEST(FittedChain, AJointsCovarianceDoesNotSeeTheSegmentsAxes) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 1});
  FittedChain fit = known_geometry(limb, 0.001);
  const Eigen::MatrixXd gauge = limb.chain.gauge();
  fit.geometry_covariance = 1e-6 * gauge * gauge.transpose();
  for (int j = 0; j < 2; ++j)
    for (const bool in_parent : {true, false})
      EXPECT_LT(fit.joint_covariance(j, in_parent).norm(), 1e-14) << j << in_parent;
}

TEST(FittedChain, AMarkerWithoutAPositionHasNoPartInTheCovariance) {
  const RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 1});
  FittedChain fit = known_geometry(limb, 0.001);
  const auto n = fit.geometry_covariance.rows();
  fit.geometry_covariance = 1e-8 * Eigen::MatrixXd::Identity(n, n);
  const double before = fit.joint_covariance(0, false).trace();
  fit.marker_weight[5] = 0.0;
  for (Eigen::Index i = 15; i < 18; ++i) fit.geometry_covariance(i, i) = 1e6;  // its coordinates
  const Matrix3d C = fit.joint_covariance(0, false);
  EXPECT_GT(C.trace(), before) << "three markers instead of four";
  EXPECT_LT(C.trace(), 1e-6);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
