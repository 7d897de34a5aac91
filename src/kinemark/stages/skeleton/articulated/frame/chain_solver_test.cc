// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;
using data::SegmentKind;
using testing_limbs::hide;
using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::move_lab;
using testing_limbs::move_slowly;
using testing_limbs::RandomChain;

int seen_on(const RandomChain& limb, std::int64_t frame, int segment) {
  int seen = 0;
  for (const int k : limb.chain.layout.markers_of(segment)) seen += limb.samples.seen(frame, k) ? 1 : 0;
  return seen;
}

// Three spheres meet in two points: both must be found, equally likely, and the frame must say so.
TEST(ChainSolver, EveryFrameOfTwoAndOneMarkerIsAMirrorPair) {
  const RandomChain limb = make_random_chain({.frames = 400, .missing = 0.4});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  int pairs = 0;
  int whole = 0;
  int both_found = 0;
  for (int f = 0; f < 400; ++f) {
    const int a = seen_on(limb, f, 0);
    const int b = seen_on(limb, f, 1);
    solver.solve(limb.samples.frame(f), nullptr, frame);
    if (std::max(a, b) == 3) {
      EXPECT_EQ(frame.state[0], CentreState::determined) << f;
      ++whole;
    }
    if (a + b == 3 && std::max(a, b) == 2) {
      EXPECT_NE(frame.state[0], CentreState::determined) << f;
      ++pairs;
      if (frame.mode_count >= 2 && std::abs(frame.modes[0].cost - frame.modes[1].cost) < 1e-8) ++both_found;
    }
    if (a + b < 3) {
      EXPECT_EQ(frame.state[0], CentreState::undetermined) << f;
    }
  }
  EXPECT_GT(pairs, 50);
  EXPECT_GT(whole, 100);
  EXPECT_GT(both_found, pairs * 8 / 10);  // the others are folds, the two grown into one
}

TEST(ChainSolver, LinesAreDeterminedWhereOneShowsTwoMarkers) {
  const RandomChain limb = make_random_chain({.frames = 200, .kind = SegmentKind::line, .missing = 0.4});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  for (int f = 0; f < 200; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    const bool two = std::max(seen_on(limb, f, 0), seen_on(limb, f, 1)) >= 2;
    EXPECT_EQ(frame.state[0] == CentreState::determined, two) << f;
  }
}

// In a chain a joint can be mirrored although its neighbours are known: no marker on the middle segment.
TEST(ChainSolver, FindsMirrorsOfInnerJoints) {
  RandomChain limb = make_random_chain({.segments = 4, .markers_per_segment = 4, .frames = 40});
  for (int f = 0; f < 40; ++f) {
    for (const int k : {8, 9, 10, 11, 13, 14}) hide(limb.samples, f, k);
  }
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  int determined = 0;  // of joint 1: the mirror of joint 2 moves it a little
  for (int f = 0; f < 40; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    EXPECT_EQ(frame.state[0], CentreState::determined);
    if (frame.state[1] == CentreState::determined) ++determined;
    EXPECT_NE(frame.state[2], CentreState::determined) << f;
  }
  EXPECT_GE(determined, 36);
}

TEST(ChainSolver, CovarianceIsThatOfRepeatedNoise) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::solid}) {
    RandomChain limb = make_random_chain({.frames = 1, .kind = kind, .noise_sd_m = 0.0});
    ChainSolver solver(known_geometry(limb, 0.001));
    ChainFrame frame;
    Random random(21, 1);
    Matrix3d scatter = Matrix3d::Zero();
    Matrix3d claimed = Matrix3d::Zero();
    const int n = 1500;
    for (int round = 0; round < n; ++round) {
      ChainSamples noisy = limb.samples;
      for (double& x : noisy.x) x += 0.001 * random.gaussian();
      solver.solve(noisy.frame(0), limb.pose.data(), frame);
      const Vector3d error = frame.centre[0] - limb.pose[0].joint0;
      scatter += error * error.transpose() / n;
      claimed += frame.own_covariance[0] / n;
    }
    EXPECT_NEAR(scatter.trace() / claimed.trace(), 1.0, 0.08);
    EXPECT_LT((scatter - claimed).norm() / claimed.norm(), 0.15);
  }
}

TEST(ChainSolver, InformationIsTheInverseOfTheOwnCovariance) {
  const RandomChain limb = make_random_chain({.frames = 1});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_LT((frame.information[0] * frame.own_covariance[0] - Matrix3d::Identity()).norm(), 1e-6);
}

TEST(ChainSolver, APathPicksTheMirror) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (const int k : {0, 3, 4}) hide(limb.samples, 0, k);
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_EQ(frame.state[0], CentreState::ambiguous);
  const Vector3d near = limb.pose[0].joint0 + Vector3d(0.004, -0.003, 0.002);
  ChainPose start;
  solver.pose_from_centres(limb.samples.frame(0), {&near, 1}, start);
  const JointPrior path{.joint = 0, .target = near, .weight = 0.01 * Matrix3d::Identity()};
  solver.solve_near(limb.samples.frame(0), start, {&path, 1}, frame);
  EXPECT_EQ(frame.state[0], CentreState::bridged);
  EXPECT_LT((frame.centre[0] - limb.pose[0].joint0).norm(), 0.01);
}

TEST(ChainSolver, AnEmptyFrameIsUndetermined) {
  RandomChain limb = make_random_chain({.frames = 1});
  for (int k = 0; k < 6; ++k) hide(limb.samples, 0, k);
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame frame;
  solver.solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_EQ(frame.mode_count, 0);
  EXPECT_EQ(frame.state[0], CentreState::undetermined);
  EXPECT_TRUE(std::isnan(frame.centre[0][0]));
}

TEST(ChainSolver, RobustWeightsHoldAgainstAnOutlier) {
  RandomChain limb = make_random_chain({.markers_per_segment = 6, .frames = 1, .noise_sd_m = 0.0005});
  for (int i = 0; i < 3; ++i) limb.samples.x[3 * 4 + static_cast<std::size_t>(i)] += 0.05;
  FittedChain fit = known_geometry(limb, 0.0005);
  ChainFrame frame;
  ChainSolver(fit).solve(limb.samples.frame(0), nullptr, frame);
  const double plain = (frame.centre[0] - limb.pose[0].joint0).norm();
  fit.robust_dof = 4.0;
  ChainSolver(fit).solve(limb.samples.frame(0), nullptr, frame);
  EXPECT_LT((frame.centre[0] - limb.pose[0].joint0).norm(), 0.3 * plain);
}

// Stagger of the order of the noise: the positions that fit lie as close together as any of them is known.
// Their mean is the answer, and it errs as much as its covariance says.
TEST(ChainSolver, PositionsThatLieTogetherAreOneWithTheSpreadOfAll) {
  const double noise_m = 0.002;
  const RandomChain limb =
      make_random_chain({.frames = 600, .stagger_m = 0.004, .noise_sd_m = noise_m, .missing = 0.3});
  ChainSolver solver(known_geometry(limb, noise_m));
  ChainFrame frame;
  double z2 = 0.0, n = 0.0;
  for (int f = 0; f < 600; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    if (frame.gathered[0] == Gathered::none) continue;
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

// Three markers of a segment whose stagger is that of the noise: no frame is left open, the spread of the
// positions is in the error bar.
TEST(ChainSolver, AWholeSegmentDeterminesItsJointBesideNoise) {
  const double noise_m = 0.003;
  const RandomChain limb = make_random_chain({.frames = 600, .stagger_m = 0.005, .noise_sd_m = noise_m});
  ChainSolver solver(known_geometry(limb, noise_m));
  ChainFrame frame;
  int several = 0, beyond = 0;
  for (int f = 0; f < 600; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, frame);
    EXPECT_EQ(frame.state[0], CentreState::determined) << f;
    several += frame.gathered[0] == Gathered::positions ? 1 : 0;
    const Vector3d error = frame.centre[0] - limb.pose[static_cast<std::size_t>(f)].joint0;
    beyond += error.squaredNorm() > 25.0 * frame.covariance[0].trace() ? 1 : 0;
  }
  EXPECT_GT(several, 0);
  EXPECT_EQ(beyond, 0);
}

// Centres move with the lab and their covariances rotate with it.
TEST(ChainSolver, MovesWithTheLab) {
  RandomChain limb =
      make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 30, .missing = 0.1});
  const FittedChain fit = known_geometry(limb, 0.001);
  const Matrix3d R = math::exp_so3({0.7, -0.4, 1.1});
  const Vector3d shift(0.5, -1.0, 2.0);
  RandomChain moved = limb;
  move_lab(moved, R, shift);
  ChainSolver solver(fit);
  ChainFrame here, there;
  for (int f = 0; f < 30; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, here);
    solver.solve(moved.samples.frame(f), nullptr, there);
    for (std::size_t j = 0; j < 2; ++j) {
      ASSERT_EQ(here.state[j], there.state[j]) << f;
      if (here.state[j] != CentreState::determined) continue;
      EXPECT_LT((R * here.centre[j] + shift - there.centre[j]).norm(), 1e-6) << f;
      EXPECT_LT((R * here.covariance[j] * R.transpose() - there.covariance[j]).norm(),
                1e-3 * here.covariance[j].norm());
    }
  }
}

TEST(ChainSolver, AWarmStartFindsWhatAColdOneFinds) {
  RandomChain limb = make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 40});
  move_slowly(limb, 60.0, 0.001);
  const FittedChain fit = known_geometry(limb, 0.001);
  ChainSolver solver(fit);
  ChainFrame cold, warm;
  for (int f = 1; f < 40; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, cold);
    solver.solve(limb.samples.frame(f), &limb.pose[static_cast<std::size_t>(f - 1)], warm);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_EQ(warm.state[j], CentreState::determined);
      EXPECT_LT((warm.centre[j] - cold.centre[j]).norm(), 1e-6) << f;
    }
    EXPECT_EQ(warm.mode_count, 1) << "no other start was tried";
  }
}

TEST(ChainSolver, AMarkerOfNoWeightIsNotSeen) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 10});
  FittedChain fit = known_geometry(limb, 0.001);
  fit.marker_weight[6] = 0.0;
  RandomChain without = limb;
  for (int f = 0; f < 10; ++f) {
    hide(without.samples, f, 6);
    limb.samples.x[static_cast<std::size_t>(3 * (8 * f + 6))] += 0.5;
  }
  ChainSolver solver(fit);
  ChainFrame wrong, hidden;
  for (int f = 0; f < 10; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, wrong);
    solver.solve(without.samples.frame(f), nullptr, hidden);
    EXPECT_EQ(wrong.seen, 7);
    EXPECT_LT((wrong.centre[0] - hidden.centre[0]).norm(), 1e-6) << f;
    EXPECT_LT((wrong.covariance[0] - hidden.covariance[0]).norm(), 1e-4 * hidden.covariance[0].norm()) << f;
  }
}

// The geometry's uncertainty adds a part to every frame's covariance, and nothing to the frame's own.
TEST(ChainSolver, TheGeometrysUncertaintyIsAdded) {
  const RandomChain limb = make_random_chain({.frames = 5});
  FittedChain fit = known_geometry(limb, 0.001);
  ChainFrame exact, wide;
  ChainSolver(fit).solve(limb.samples.frame(2), nullptr, exact);
  EXPECT_EQ(exact.covariance[0], exact.own_covariance[0]);
  const auto n = fit.geometry_covariance.rows();
  fit.geometry_covariance = 1e-6 * Eigen::MatrixXd::Identity(n, n);
  ChainSolver(fit).solve(limb.samples.frame(2), nullptr, wide);
  EXPECT_EQ(wide.own_covariance[0], exact.own_covariance[0]);
  EXPECT_GT((wide.covariance[0] - exact.covariance[0]).trace(), 0.0);
}

TEST(ChainSolver, WithoutPriorsSolveNearIsTheNearestMinimum) {
  const RandomChain limb = make_random_chain({.frames = 5});
  ChainSolver solver(known_geometry(limb, 0.001));
  ChainFrame all, near;
  for (int f = 0; f < 5; ++f) {
    solver.solve(limb.samples.frame(f), nullptr, all);
    const double cost =
        solver.solve_near(limb.samples.frame(f), limb.pose[static_cast<std::size_t>(f)], {}, near);
    EXPECT_NEAR(cost, all.modes[0].cost, 1e-6 * cost);
    EXPECT_LT((near.centre[0] - all.centre[0]).norm(), 1e-6);
    EXPECT_EQ(near.state[0], CentreState::bridged);
  }
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
