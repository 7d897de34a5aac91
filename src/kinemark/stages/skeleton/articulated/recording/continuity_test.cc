// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/continuity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;
using testing_limbs::hide;
using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::move_slowly;
using testing_limbs::RandomChain;

constexpr double kRate_hz = 60.0;
constexpr double kNoise_m = 0.001;

RandomChain slow_limb(int frames) {
  RandomChain limb = make_random_chain({.frames = frames});
  move_slowly(limb, kRate_hz, kNoise_m);
  return limb;
}

struct Followed {
  RecordingPass pass;
  Continuity continuity;
};

Followed follow(const RandomChain& limb, int threads = 1) {
  const FittedChain fit = known_geometry(limb, kNoise_m);
  Followed out{.pass = pass_over(fit, limb.samples, 1, {}).value(), .continuity = {}};
  out.continuity = follow_paths(fit, limb.samples, kRate_hz, threads, out.pass);
  return out;
}

double error_of(const RandomChain& limb, const Vector3d& centre, std::size_t f) {
  return (centre - limb.pose[f].joint0).norm();
}

// Three markers in all leave two mirrored positions; the path through the frames around decides.
TEST(Continuity, ThePathChoosesAmongMirroredPositions) {
  RandomChain limb = slow_limb(180);
  for (int f = 80; f < 86; ++f)
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
  const Followed found = follow(limb);
  ASSERT_TRUE(found.continuity.prior[0].follows);
  for (std::size_t f = 80; f < 86; ++f) {
    EXPECT_NE(found.pass.state[0][f], CentreState::determined) << f;
    ASSERT_TRUE(found.continuity.path[0].known(f)) << f;
    EXPECT_LT(error_of(limb, found.continuity.path[0].position[f], f), 0.005) << f;
  }
}

TEST(Continuity, APathThroughFramesWithoutMarkersIsWideAndHonest) {
  RandomChain limb = slow_limb(180);
  for (int f = 90; f < 100; ++f)
    for (int k = 0; k < 6; ++k) hide(limb.samples, f, k);
  const Followed found = follow(limb);
  const SmoothedPath& path = found.continuity.path[0];
  ASSERT_EQ(path.position.size(), 180U);
  EXPECT_GT(path.covariance_at(95).trace(), path.covariance_at(60).trace());
  for (std::size_t f = 90; f < 100; ++f) {
    EXPECT_TRUE(found.pass.points[0][f].information.isZero(0.0)) << "the frame shows nothing";
    EXPECT_LT(std::pow(error_of(limb, path.position[f], f), 2), 25.0 * path.covariance_at(f).trace()) << f;
  }
}

TEST(Continuity, SmoothingLowersTheError) {
  const RandomChain limb = slow_limb(200);
  const Followed found = follow(limb);
  double single = 0.0, smooth = 0.0;
  for (std::size_t f = 0; f < 200; ++f) {
    single += std::pow(error_of(limb, found.pass.points[0][f].position, f), 2);
    smooth += std::pow(error_of(limb, found.continuity.path[0].position[f], f), 2);
  }
  EXPECT_LT(smooth, 0.5 * single);
}

TEST(Continuity, AnyNumberOfThreadsGivesTheSameBits) {
  RandomChain limb = slow_limb(400);
  for (int f = 40; f < 360; ++f)
    for (const int k : {f % 3, 3 + f % 2, 3 + (f + 1) % 2}) hide(limb.samples, f, k);
  const Followed one = follow(limb, 1), three = follow(limb, 3);
  EXPECT_GT(one.pass.flagged.size(), 256U) << "more than one chunk";
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  EXPECT_TRUE(
      std::ranges::equal(one.continuity.path[0].covariance, three.continuity.path[0].covariance, same));
}

TEST(Continuity, NothingIsSmoothedWhereFramesDoNotFollowEachOther) {
  const Followed random = follow(make_random_chain({.frames = 120}));
  EXPECT_FALSE(random.continuity.prior[0].follows);
  EXPECT_TRUE(random.continuity.path[0].position.empty());
  const Followed few = follow(slow_limb(9));
  EXPECT_EQ(few.continuity.prior[0].white_jerk, 0.0) << "fewer than ten frames";
  EXPECT_TRUE(few.continuity.path[0].position.empty());
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
