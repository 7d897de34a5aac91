// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/frame_information.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

TEST(FrameInformation, TellsWhichFramesHoldTheJoint) {
  RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  PoseSolver solver(limb.chain);
  FrameInformation information;
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  Eigen::Matrix3Xd by_frame;
  Eigen::Matrix3Xd by_geometry;
  const auto holds = [&](const ChainSamples& samples) {
    solver.set(samples.frame(0));
    solver.normal(limb.pose[0], {}, false, H, b);
    information.set(limb.chain, H);
    solver.joint_jacobian(limb.pose[0], 0, by_frame, by_geometry);
    return information.holds(by_frame);
  };
  EXPECT_TRUE(holds(limb.samples));
  EXPECT_EQ(information.rank(), 9);
  hide(limb.samples, 0, 0);
  hide(limb.samples, 0, 3);
  EXPECT_TRUE(holds(limb.samples));  // (2, 2)
  hide(limb.samples, 0, 4);
  EXPECT_TRUE(holds(limb.samples));  // (2, 1): a mirror pair, but each of full rank on the joint
  EXPECT_EQ(information.rank(), 8);  // the turn about the line from joint to the one marker is open
  hide(limb.samples, 0, 1);
  EXPECT_FALSE(holds(limb.samples));  // (1, 1): a circle
  const Eigen::SelfAdjointEigenSolver<Matrix3d> left(information.joint_information(by_frame));
  EXPECT_NEAR(left.eigenvalues()[0], 0.0, 1e-9);
  EXPECT_GT(left.eigenvalues()[1], 1e-3);
}

/// Normal matrix of a frame at its true pose.
Eigen::MatrixXd normal_of(const RandomChain& limb) {
  PoseSolver solver(limb.chain);
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  solver.set(limb.samples.frame(0));
  solver.normal(limb.pose[0], {}, false, H, b);
  return H;
}

TEST(FrameInformation, IsTheInverseWhereAllIsDetermined) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 1, .noise_sd_m = 0.0});
  const Eigen::MatrixXd H = normal_of(limb);
  FrameInformation information;
  information.set(limb.chain, H);
  const auto n = H.rows();
  EXPECT_EQ(information.rank(), n);
  EXPECT_LT((information.inverse() * H - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-6);
}

// The pseudo-inverse does what one must, whatever the rank: H X H = H.
TEST(FrameInformation, IsAPseudoInverseWhereSomethingIsOpen) {
  RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  for (const int k : {0, 1, 3}) hide(limb.samples, 0, k);
  const Eigen::MatrixXd H = normal_of(limb);
  FrameInformation information;
  information.set(limb.chain, H);
  EXPECT_LT(information.rank(), H.rows());
  EXPECT_LT((H * information.inverse() * H - H).norm(), 1e-5 * H.norm());
}

TEST(FrameInformation, LogDetFallsWithTheNoiseAndEndsWithoutMarkers) {
  const RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  const Eigen::MatrixXd H = normal_of(limb);
  Eigen::MatrixXd scratch;
  const double fine = FrameInformation::log_det(limb.chain, H, 0.001, scratch);
  const double coarse = FrameInformation::log_det(limb.chain, H, 0.002, scratch);
  EXPECT_NEAR(fine - coarse, 2.0 * 9.0 * std::log(2.0), 0.1) << "nine parameters";
  EXPECT_TRUE(std::isinf(FrameInformation::log_det(limb.chain, Eigen::MatrixXd::Zero(9, 9), 0.001, scratch)));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
