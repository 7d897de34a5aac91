// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/robust_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

constexpr double kNoise_m = 0.001;
constexpr double kDof = 5.0;

struct Weighed {
  RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  std::vector<double> weights;

  bool weigh(const std::vector<double>& own = std::vector<double>(6, 1.0)) {
    return robust_weights(limb.chain, limb.pose[0], limb.samples.frame(0), own, kDof, kNoise_m, weights);
  }
  void push(int marker, double distance_m) {
    limb.samples.x[static_cast<std::size_t>(3 * marker)] += distance_m;
  }
};

TEST(RobustWeights, AreStudentsWithADistanceOfTenSd) {
  Weighed w;
  w.push(4, 10.0 * kNoise_m);
  EXPECT_TRUE(w.weigh());
  EXPECT_NEAR(w.weights[4], (kDof + 3.0) / (kDof + 100.0), 1e-9);
  for (const std::size_t k : {0U, 1U, 2U, 3U, 5U})
    EXPECT_EQ(w.weights[k], 1.0) << "never above its own weight";
  EXPECT_FALSE(w.weigh()) << "nothing changes any more";
}

TEST(RobustWeights, FallWithTheDistance) {
  double before = 1.0;
  for (const double distance_m : {0.003, 0.006, 0.012, 0.1}) {
    Weighed w;
    w.push(0, distance_m);
    (void)w.weigh();
    EXPECT_LT(w.weights[0], before);
    before = w.weights[0];
  }
  EXPECT_GT(before, 0.0);
}

TEST(RobustWeights, AMarkersOwnWeightScalesItsNoise) {
  Weighed w;
  w.push(2, 10.0 * kNoise_m);
  std::vector<double> own(6, 1.0);
  own[2] = 0.01;  // ten times the noise: one SD away
  (void)w.weigh(own);
  EXPECT_NEAR(w.weights[2], 0.01, 1e-12);
}

TEST(RobustWeights, HiddenMarkersKeepTheirs) {
  Weighed w;
  (void)w.weigh();
  w.weights[3] = 0.25;
  hide(w.limb.samples, 0, 3);
  EXPECT_FALSE(w.weigh());
  EXPECT_EQ(w.weights[3], 0.25);
}

TEST(RobustShare, IsWhatTheWeightsLeaveOfGaussianNoise) {
  Random random(11, 0);
  constexpr double kLeft = 0.6, kShareDof = 30.0;
  double all = 0.0, left = 0.0;
  for (int i = 0; i < 200000; ++i) {
    double r2 = 0.0;
    for (int axis = 0; axis < 3; ++axis) r2 += kLeft * std::pow(random.gaussian(), 2);
    all += r2;
    left += r2 * std::min(1.0, (kShareDof + 3.0) / (kShareDof + r2));
  }
  EXPECT_NEAR(robust_share(kShareDof, kLeft), left / all, 5e-4);
}

TEST(RobustShare, IsAllOfItWhereNoWeightFalls) {
  EXPECT_NEAR(robust_share(1e9, 1.0), 1.0, 1e-6);
  EXPECT_NEAR(robust_share(30.0, 1e-6), 1.0, 1e-6) << "residuals that the fit took up";
  EXPECT_LT(robust_share(5.0, 1.0), robust_share(30.0, 1.0));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
