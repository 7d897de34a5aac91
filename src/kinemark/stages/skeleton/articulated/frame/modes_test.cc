// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using data::CentreState;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

constexpr double kNoise_m = 0.001;

/// A frame's modes, from the true geometry.
struct Found {
  FrameSolver solver;
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
    Eigen::Matrix3Xd by_frame, by_globals;
    solver.normal(modes[0].pose, {}, false, H, b);
    FrameInformation information;
    information.set(solver.chain(), H);
    solver.joint_jacobian(modes[0].pose, 0, by_frame, by_globals);
    return kNoise_m * kNoise_m * by_frame * information.inverse() * by_frame.transpose();
  }
};

ChainFit known_geometry(const RandomChain& limb, double noise_m) {
  ChainFit fit;
  fit.chain = limb.chain;
  fit.noise_sd_m = noise_m;
  fit.marker_weight.assign(static_cast<std::size_t>(limb.chain.markers()), 1.0);
  const auto n = static_cast<Eigen::Index>(limb.chain.globals().size());
  fit.global_covariance = Eigen::MatrixXd::Zero(n, n);
  return fit;
}

TEST(ModeFinder, ThreeMarkersLeaveTwoMirroredPlacesOfEqualWeight) {
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

// Three markers whose two mirrored places have grown into one: the likelihood there is a flat trough, but
// where noise has driven the two far past each other.
TEST(Profile, AFoldIsNoGaussian) {
  RandomChain limb = make_random_chain({.frames = 200, .stagger_m = 0.01});
  int folds = 0, told = 0;
  for (int f = 0; f < 200; ++f) {
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
    Found found(limb, f);
    if (found.count != 1) continue;
    const ChainMode& best = found.modes[0];
    ++folds;
    if (!profile_is_gaussian(found.solver, best.pose, best.cost, 0, found.covariance(), kNoise_m)) ++told;
  }
  EXPECT_GT(folds, 10);
  EXPECT_GT(told, folds * 8 / 10);
}

// Stagger of the order of the noise: the places that fit lie as close together as any of them is known.
// Their mean is the answer, and it errs as much as its covariance says.
TEST(Verdict, PlacesThatLieTogetherAreOneWithTheSpreadOfAll) {
  const double noise_m = 0.002;
  const RandomChain limb =
      make_random_chain({.frames = 600, .stagger_m = 0.004, .noise_sd_m = noise_m, .missing = 0.3});
  ChainSolver solver(known_geometry(limb, noise_m));
  ChainFrame frame;
  double z2 = 0.0, n = 0.0;
  for (int f = 0; f < 600; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    if (!frame.gathered) continue;
    EXPECT_EQ(frame.state[0], CentreState::determined);
    const Vector3d error = frame.centre[0] - limb.pose[static_cast<std::size_t>(f)].joint0;
    EXPECT_LT(error.squaredNorm(), 25.0 * frame.covariance[0].trace()) << f;
    EXPECT_LT((frame.information[0] * frame.own_covariance[0] - Matrix3d::Identity()).norm(), 1e-6);
    z2 += error.squaredNorm() / frame.covariance[0].trace();
    n += 1.0;
  }
  ASSERT_GT(n, 20.0);
  EXPECT_GT(z2 / n, 0.6);
  EXPECT_LT(z2 / n, 1.5);
}

}  // namespace
}  // namespace kinemark::skeleton
