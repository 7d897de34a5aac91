// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/pose_starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/frame/modes.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::random_rotation;
using testing_limbs::RandomChain;

// The closed start of two lines and the general solver reach the same minimum from anywhere.
TEST(PoseStarts, TwoLinesNeedNoOtherStarts) {
  const RandomChain limb = make_random_chain(
      {.frames = 60, .kind = SegmentKind::line, .noise_sd_m = 0.003, .missing = 0.25, .seed = 5});
  PoseSolver solver(limb.chain);
  ModeFinder finder(limb.chain);
  std::vector<ChainMode> modes;
  Random random(11, 1);
  for (int f = 0; f < 60; ++f) {
    solver.set(limb.samples.frame(f));
    if (std::max(solver.sums().segment[0].seen, solver.sums().segment[1].seen) < 2) continue;
    ASSERT_GT(finder.find(solver, limb.samples.frame(f), 0.003, nullptr, 40, modes), 0);
    for (int start = 0; start < 4; ++start) {
      ChainPose pose{.joint0 = limb.pose[f].joint0, .rotation = {}};
      for (int s = 0; s < 2; ++s) pose.rotation.push_back(random_rotation(random));
      const double cost = solver.refine(pose, {}, 100);
      EXPECT_GE(cost, modes[0].cost - 1e-9 * modes[0].cost - 1e-14) << f;
    }
  }
}

/// Costs of all starts of a frame, least first.
std::vector<double> start_costs(const Chain& chain, const double* x) {
  PoseSolver solver(chain);
  solver.set(x);
  PoseStarts starts(chain);
  starts.find(solver, x, 0.003);
  std::vector<double> costs;
  for (const ChainPose& pose : starts.poses()) costs.push_back(solver.cost(pose));
  std::sort(costs.begin(), costs.end());
  return costs;
}

TEST(PoseStarts, OneOfThemIsThePoseItselfOnExactData) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb = make_random_chain({.segments = 3, .frames = 5, .kind = kind, .noise_sd_m = 0.0});
    for (int f = 0; f < 5; ++f) {
      const auto costs = start_costs(limb.chain, limb.samples.frame(f));
      ASSERT_FALSE(costs.empty());
      EXPECT_LT(costs.front(), 1e-12) << data::to_string(kind) << ' ' << f;
    }
  }
}

TEST(PoseStarts, OfLongChainsAreThoseOfJointsThatNoSegmentShows) {
  RandomChain limb = make_random_chain({.segments = 4, .frames = 1, .noise_sd_m = 0.0});
  PoseSolver solver(limb.chain);
  PoseStarts starts(limb.chain);
  const auto count = [&](double sigma_m) {
    solver.set(limb.samples.frame(0));
    starts.find(solver, limb.samples.frame(0), sigma_m);
    return starts.poses().size();
  };
  // A rigid pose and its half turn; of joints in doubt two trilaterations, of segments with two markers four
  // rotations.
  EXPECT_EQ(count(1e-4), 2U);
  EXPECT_EQ(count(1.0), 4U * 2 + 3 * 2) << "beside this noise no segment shows its pose";
  for (const int segment : {2, 3}) hide(limb.samples, 0, limb.chain.layout.markers_of(segment).front());
  EXPECT_EQ(count(1e-4), 2U + 4 + 4 + 2);
}

TEST(PoseStarts, MoveWithTheLab) {
  RandomChain limb = make_random_chain({.segments = 3, .frames = 8});
  const Matrix3d R = math::exp_so3({0.4, 1.1, -0.7});
  for (int f = 0; f < 8; ++f) {
    const auto before = start_costs(limb.chain, limb.samples.frame(f));
    double* x = limb.samples.x.data() + 27 * static_cast<std::ptrdiff_t>(f);
    for (int k = 0; k < 9; ++k) {
      Eigen::Map<Vector3d> p(x + 3 * k);
      p = (R * p + Vector3d(0.3, -0.2, 0.9)).eval();
    }
    const auto after = start_costs(limb.chain, x);
    ASSERT_EQ(before.size(), after.size()) << f;
    if (!before.empty()) {
      EXPECT_NEAR(after.front(), before.front(), 1e-9 + 1e-6 * before.front()) << f;
    }
  }
}

TEST(PoseStarts, OneMarkerHasOneAndNoneHasNone) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (int k = 0; k < 5; ++k) hide(limb.samples, 0, k);
  const auto one = start_costs(limb.chain, limb.samples.frame(0));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_TRUE(std::isfinite(one[0]));
  hide(limb.samples, 0, 5);
  EXPECT_TRUE(start_costs(limb.chain, limb.samples.frame(0)).empty());
}

TEST(PoseStarts, RotationsFollowFromTrueCentres) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 4, .noise_sd_m = 0.0});
  PoseSolver solver(limb.chain);
  PoseStarts starts(limb.chain);
  ChainPose found;
  for (int f = 0; f < 4; ++f) {
    const ChainPose& truth = limb.pose[static_cast<std::size_t>(f)];
    const std::vector<Vector3d> centres{limb.chain.joint_centre(truth, 0), limb.chain.joint_centre(truth, 1)};
    solver.set(limb.samples.frame(f));
    starts.from_centres(solver, centres, found);
    for (std::size_t s = 0; s < 3; ++s)
      EXPECT_LT((found.rotation[s] - truth.rotation[s]).norm(), 1e-6) << f << ' ' << s;
  }
}

TEST(PoseStarts, TheRigidPoseOfExactMarkersIsTheTruth) {
  RandomChain limb =
      make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 5, .noise_sd_m = 0.0});
  for (int f = 0; f < 5; ++f) {
    hide(limb.samples, f, 0);  // the second segment shows most
    PoseSolver solver(limb.chain);
    PoseStarts starts(limb.chain);
    solver.set(limb.samples.frame(f));
    EXPECT_LT(solver.cost(starts.find_rigid(solver)), 1e-15) << f;
  }
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
