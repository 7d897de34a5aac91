// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

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

using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

constexpr double kNoise_m = 0.001;

/// A frame's modes, from the true geometry.
struct Found {
  PoseSolver solver;
  ModeFinder finder;
  std::vector<ChainMode> modes;
  int count = 0;

  Found(const RandomChain& limb, int frame) : solver(limb.chain), finder(limb.chain) {
    solver.set(limb.samples.frame(frame));
    count = finder.find(solver, limb.samples.frame(frame), kNoise_m, nullptr, 40, modes);
  }
  [[nodiscard]] Matrix3d covariance() {
    Eigen::MatrixXd H;
    Eigen::VectorXd b;
    Eigen::Matrix3Xd by_frame, by_geometry;
    solver.normal(modes[0].pose, {}, false, H, b);
    FrameInformation information;
    information.set(solver.chain(), H);
    solver.joint_jacobian(modes[0].pose, 0, by_frame, by_geometry);
    return kNoise_m * kNoise_m * by_frame * information.inverse() * by_frame.transpose();
  }
};

TEST(ModeFinder, ThreeMarkersLeaveTwoMirroredPositionsOfEqualWeight) {
  RandomChain limb = make_random_chain({.frames = 30, .noise_sd_m = 0.0});
  int pairs = 0;
  for (int f = 0; f < 30; ++f) {
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
    const Found found(limb, f);
    ASSERT_GE(found.count, 1);
    double sum = 0.0;
    for (int i = 0; i < found.count; ++i) {
      sum += found.modes[static_cast<std::size_t>(i)].weight;
      if (i > 0) {
        EXPECT_GE(found.modes[static_cast<std::size_t>(i)].cost,
                  found.modes[static_cast<std::size_t>(i - 1)].cost);
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    if (found.count < 2 || found.modes[1].cost > 1e-12) continue;
    ++pairs;
    EXPECT_NEAR(found.modes[0].weight, found.modes[1].weight, 0.02) << f;
    // Both at the same distance from each of the three markers.
    for (const int k : {1, 2, 5}) {
      const Eigen::Map<const Vector3d> x(limb.samples.frame(f) + 3 * k);
      EXPECT_NEAR((found.modes[0].centre[0] - x).norm(), (found.modes[1].centre[0] - x).norm(), 1e-6);
    }
  }
  EXPECT_GT(pairs, 22);
}

TEST(ModeFinder, AFrameWithoutMarkersHasNone) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (int k = 0; k < 6; ++k) hide(limb.samples, 0, k);
  EXPECT_EQ(Found(limb, 0).count, 0);
}

TEST(Profile, IsAGaussianWhereAllIsSeen) {
  const RandomChain limb = make_random_chain({.frames = 5});
  for (int f = 0; f < 5; ++f) {
    Found found(limb, f);
    const Matrix3d C = found.covariance();
    const ChainMode& best = found.modes[0];
    EXPECT_TRUE(profile_is_gaussian(found.solver, best.pose, best.cost, 0, C, kNoise_m));
    const auto moments = profile_moments(found.solver, best.pose, best.cost, 0, C, kNoise_m);
    ASSERT_TRUE(moments.has_value());
    EXPECT_NEAR(moments->variance_ratio, 1.0, 0.1);
    EXPECT_LT(moments->shift.norm(), 0.1 * std::sqrt(C.trace()));
    EXPECT_LT(moments->more.norm(), 0.1 * C.norm());
  }
}

// Three markers whose two mirrored positions have grown into one: the likelihood there is a flat trough, but
// where noise has driven the two far past each other.
TEST(Profile, AFoldIsNoGaussian) {
  RandomChain limb = make_random_chain({.frames = 200, .stagger_m = 0.01});
  int folds = 0, noticed = 0;
  for (int f = 0; f < 200; ++f) {
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
    Found found(limb, f);
    if (found.count != 1) continue;
    const ChainMode& best = found.modes[0];
    ++folds;
    if (!profile_is_gaussian(found.solver, best.pose, best.cost, 0, found.covariance(), kNoise_m)) ++noticed;
  }
  EXPECT_GT(folds, 10);
  EXPECT_GT(noticed, folds * 8 / 10);
}

TEST(ModeFinder, AnExtraStartIsTriedToo) {
  RandomChain limb = make_random_chain({.frames = 10});
  for (int f = 0; f < 10; ++f) {
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
    Found found(limb, f);
    ASSERT_GE(found.count, 1);
    const double before = found.modes[0].cost;
    found.count = found.finder.find(found.solver, limb.samples.frame(f), kNoise_m,
                                    &limb.pose[static_cast<std::size_t>(f)], 40, found.modes);
    EXPECT_GE(found.count, 1);
    EXPECT_LE(found.modes[0].cost, before * (1.0 + 1e-6) + 1e-12) << "never worse for it";
  }
}

TEST(ModeFinder, WholeSegmentsLeaveOneModeOfAllWeight) {
  const RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 10});
  for (int f = 0; f < 10; ++f) {
    const Found found(limb, f);
    ASSERT_GE(found.count, 1);
    EXPECT_GT(found.modes[0].weight, 0.999) << f;
    EXPECT_LT((found.modes[0].centre[0] - limb.pose[static_cast<std::size_t>(f)].joint0).norm(), 0.01);
  }
}

// A covariance a hundred times too small makes steps within which nothing can be seen.
TEST(Profile, HasNoMomentsWhereItsStepsAreWrong) {
  const RandomChain limb = make_random_chain({.frames = 3});
  for (int f = 0; f < 3; ++f) {
    Found found(limb, f);
    const ChainMode& best = found.modes[0];
    const Matrix3d C = found.covariance();
    EXPECT_FALSE(profile_moments(found.solver, best.pose, best.cost, 0, 1e-4 * C, kNoise_m).has_value())
        << "open ends";
    EXPECT_FALSE(profile_moments(found.solver, best.pose, best.cost, 0, 100.0 * C, kNoise_m).has_value())
        << "too coarse";
    EXPECT_FALSE(profile_is_gaussian(found.solver, best.pose, best.cost, 0, 100.0 * C, kNoise_m));
  }
}

TEST(ModeFinder, WholeFramesConfirmTheirMinimumAndNoOther) {
  const RandomChain limb = make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 20});
  for (int f = 0; f < 20; ++f) {
    Found found(limb, f);
    ChainPose pose = limb.pose[f];
    double cost = found.solver.refine(pose);
    EXPECT_TRUE(found.finder.confirm(found.solver, kNoise_m, 40, pose, cost)) << f;
    EXPECT_NEAR(cost, found.modes[0].cost, 1e-9 * cost + 1e-14) << f;
    ChainPose elsewhere = limb.pose[f];
    elsewhere.joint0 += Vector3d(0.01, 0.0, 0.0);
    cost = found.solver.cost(elsewhere);
    EXPECT_FALSE(found.finder.confirm(found.solver, kNoise_m, 40, elsewhere, cost)) << f;
  }
}

}  // namespace

}  // namespace kinemark::skeleton::articulated
