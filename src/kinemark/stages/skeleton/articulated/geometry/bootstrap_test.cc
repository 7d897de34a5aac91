// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/true_poses.h"

namespace kinemark::skeleton::articulated {
namespace {

using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

PosedFrames true_frames(const RandomChain& limb) {
  PosedFrames out{.frame = {}, .pose = limb.pose, .weight = {}};
  for (std::int64_t f = 0; f < limb.samples.frames; ++f) out.frame.push_back(f);
  return out;
}

TEST(JointFigures, AJointReachesToTheNearestMarkerOfItsFartherSegment) {
  RandomChain limb = make_random_chain({.segments = 3, .frames = 2});
  Chain& chain = limb.chain;
  chain.joint.col(1) = Vector3d(0.0, 0.0, 0.5);
  for (const int k : chain.layout.markers_of(1)) chain.marker.col(k) = Vector3d(0.0, 0.0, 0.1 + 0.01 * k);
  for (const int k : chain.layout.markers_of(2)) chain.marker.col(k) = Vector3d(0.01 * k, 0.0, 0.0);
  const int last = chain.layout.markers_of(1).back();
  EXPECT_NEAR(reach_of(chain, 1), 0.4 - 0.01 * last, 1e-15);
  chain.joint(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(reach_of(chain, 1)));
}

TEST(JointFigures, OfRigidSegmentsADistanceDoesNotChange) {
  const RandomChain exact = make_random_chain({.segments = 3, .frames = 60, .noise_sd_m = 0.0});
  for (const int j : {0, 1})
    EXPECT_LT(distance_change(exact.chain, exact.samples, true_frames(exact), j), 1e-12) << j;
}

TEST(JointFigures, OfAMarkerThatStandsStillItIsTheScatterOfItsDistance) {
  RandomChain limb = make_random_chain({.segments = 2, .frames = 80, .noise_sd_m = 0.0});
  const int k = limb.chain.layout.markers_of(1).front();
  double sum = 0.0, squares = 0.0;
  for (std::int64_t f = 0; f < 80; ++f) {
    Eigen::Map<Vector3d> x(limb.samples.x.data() + 3 * (f * limb.samples.markers + k));
    x = Vector3d(0.3, 0.1, -0.2);
    const double d = (x - limb.chain.joint_centre(limb.pose[static_cast<std::size_t>(f)], 0)).norm();
    sum += d;
    squares += d * d;
  }
  const double scatter = std::sqrt(squares / 80.0 - sum / 80.0 * (sum / 80.0));
  ASSERT_GT(scatter, 0.01);
  EXPECT_NEAR(distance_change(limb.chain, limb.samples, true_frames(limb), 0), scatter, 1e-12);
}

TEST(JointFigures, AMarkerThatIsNotSeenDoesNotCountAndNoNumberIsInfinite) {
  RandomChain limb = make_random_chain({.segments = 2, .frames = 30, .noise_sd_m = 0.0});
  const int k = limb.chain.layout.markers_of(0).front();
  for (std::int64_t f = 1; f < 30; ++f)
    limb.samples.x[static_cast<std::size_t>(3 * (f * limb.samples.markers + k))] =
        std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(distance_change(limb.chain, limb.samples, true_frames(limb), 0), 1e-12);
  PosedFrames broken = true_frames(limb);
  broken.pose[3].joint0[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(distance_change(limb.chain, limb.samples, broken, 0)));
}

using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;
using testing_limbs::true_poses;

// Turns that the noise nearly hides fit it: residuals come out too small, shapes too wide.
TEST(Bootstrap, SeesWhatWeakTurnsDo) {
  const RandomChain weak = make_random_chain({.frames = 150, .stagger_m = 0.004, .noise_sd_m = 0.003});
  const RandomChain firm = make_random_chain({.frames = 150});
  EXPECT_TRUE(has_weak_rotation(weak.chain, 0.003));
  EXPECT_FALSE(has_weak_rotation(firm.chain, 0.001));
  const Bootstrap found = bootstrap(weak.samples, true_poses(weak), known_geometry(weak, 0.003), 1);
  EXPECT_LT(found.chi2_ratio, 0.97);
  EXPECT_GT(found.variance_ratio, 0.9);
  Chain wider = weak.chain;
  wider.move_geometry(found.bias);
  EXPECT_GT(wider.marker.topRows<2>().norm(), weak.chain.marker.topRows<2>().norm());
}

// Rotations that stand far out of the noise are Gaussian: nothing to correct.
TEST(Bootstrap, FindsNoBiasWhereRotationsAreFirm) {
  const RandomChain limb = make_random_chain({.frames = 120});
  const FittedChain fit = known_geometry(limb, 0.001);
  const Bootstrap found = bootstrap(limb.samples, true_poses(limb), fit, 2);
  EXPECT_NEAR(found.chi2_ratio, 1.0, 0.12);
  EXPECT_NEAR(found.variance_ratio, 1.0, 0.3);
  EXPECT_LT(found.bias.cwiseAbs().maxCoeff(), 0.001);
  EXPECT_LT((limb.chain.gauge().transpose() * found.bias).norm(), 1e-12) << "a gauge is no bias";
  EXPECT_EQ(bootstrap(limb.samples, true_poses(limb), fit, 2).bias, found.bias) << "the same seed";
}

TEST(HasWeakRotation, LinesAndPairsOfMarkersHaveNoneToLose) {
  const RandomChain line = make_random_chain({.frames = 1, .kind = data::SegmentKind::line});
  EXPECT_FALSE(has_weak_rotation(line.chain, 0.05));
  const RandomChain pair = make_random_chain({.markers_per_segment = 2, .frames = 1});
  EXPECT_FALSE(has_weak_rotation(pair.chain, 0.05));
}

TEST(Bootstrap, WithoutFramesThereIsNothingToCorrect) {
  const RandomChain limb = make_random_chain({.frames = 5});
  const Bootstrap found = bootstrap(limb.samples, {}, known_geometry(limb, 0.001), 1);
  EXPECT_EQ(found.chi2_ratio, 1.0);
  EXPECT_EQ(found.variance_ratio, 1.0);
}

}  // namespace

}  // namespace kinemark::skeleton::articulated
