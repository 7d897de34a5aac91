// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/score.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::Rotations;

struct Both {
  testing::TestChain chain;
  SegmentPoses a, b;
  RelativeMotion motion;
  explicit Both(const testing::ChainSetup& setup) : chain(testing::make_chain(setup)) {
    a = find_segment_poses({chain.markers, {}}, "a", chain.layout.segments[0].markers);
    b = find_segment_poses({chain.markers, {}}, "b", chain.layout.segments[1].markers);
    motion = measure_motion(a, b);
  }
  [[nodiscard]] JointFit fit(data::JointKind kind) const {
    return fit_score({chain.markers, {}}, a, b, motion, kind);
  }
  /// Mean over frames of the true centre in the parent's axes.
  [[nodiscard]] Eigen::Vector3d truth_in_parent() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto f : motion.frames) sum += a.to_segment(f, chain.centres[0].col(f));
    return sum / static_cast<double>(motion.frames.size());
  }
};

TEST(Score, ExactDataGiveTheExactCentre) {
  for (const auto rotations : {Rotations::anywhere, Rotations::cone}) {
    const Both both({.rotations = rotations, .missing = 0.1});
    const auto fit = both.fit(data::JointKind::ball);
    ASSERT_TRUE(fit.in_parent && fit.in_child);
    EXPECT_LT(fit.residual_rms_m, 1e-7);
    for (const auto f : both.motion.frames) {
      EXPECT_LT((both.a.to_world(f, fit.centre.head<3>()) - both.chain.centres[0].col(f)).norm(), 1e-6);
      EXPECT_LT((both.b.to_world(f, fit.centre.tail<3>()) - both.chain.centres[0].col(f)).norm(), 1e-6);
    }
  }
}

TEST(Score, AHingeHasItsAxisAndAPointOnIt) {
  const Both both({.rotations = Rotations::hinge, .range_rad = 1.2});
  const auto fit = both.fit(data::JointKind::hinge);
  EXPECT_EQ(fit.method, "SARA");
  for (const auto f : both.motion.frames) {
    const auto i = static_cast<std::size_t>(f);
    const Eigen::Vector3d axis = both.chain.world_from_segment[0][i].col(0);
    EXPECT_NEAR(std::abs(axis.dot(both.a.world_from_segment[i] * fit.axis_in_parent)), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(axis.dot(both.b.world_from_segment[i] * fit.axis_in_child)), 1.0, 1e-9);
    const Eigen::Vector3d off = both.a.to_world(f, fit.centre.head<3>()) - both.chain.centres[0].col(f);
    EXPECT_LT((off - axis * axis.dot(off)).norm(), 1e-6);
  }
}

TEST(Score, CovarianceCoversTheTruth) {
  int inside = 0;
  const int runs = 60;
  for (int seed = 1; seed <= runs; ++seed) {
    const Both both({.frames = 200,
                     .per_segment = 4,
                     .stagger_m = 0.03,
                     .rotations = Rotations::cone,
                     .range_rad = 1.2,
                     .noise_sd_m = 0.001,
                     .seed = static_cast<std::uint64_t>(seed)});
    const auto fit = both.fit(data::JointKind::ball);
    const Eigen::Vector3d d = fit.centre.head<3>() - both.truth_in_parent();
    inside += d.dot(fit.covariance.topLeftCorner<3, 3>().inverse() * d) < 7.815;  // 95 % of chi-square, 3
  }
  EXPECT_GE(inside, 50) << "of 60; 57 expected";
}

TEST(Score, WhatTheMotionLeavesOpenIsWide) {
  // A hinge fitted as a ball: the position is not determined along the axis, but across it.
  const Both both({.per_segment = 5,
                   .stagger_m = 0.04,
                   .rotations = Rotations::hinge,
                   .range_rad = 1.0,
                   .noise_sd_m = 0.0005});
  const auto fit = both.fit(data::JointKind::ball);
  const auto hinge = both.fit(data::JointKind::hinge);
  const Eigen::Matrix3d c = fit.covariance.topLeftCorner<3, 3>();
  EXPECT_GT(std::sqrt(hinge.axis_in_parent.dot(c * hinge.axis_in_parent)), 0.05);
  EXPECT_LT(hinge.axis_sd_rad, 0.05);  // skin may turn with the hinge and leave no trace: the prior's figure
  const Both still({.per_segment = 5,
                    .stagger_m = 0.04,
                    .rotations = Rotations::cone,
                    .range_rad = 0.0,
                    .noise_sd_m = 0.0005});
  const Eigen::Matrix3d open = still.fit(data::JointKind::ball).covariance.topLeftCorner<3, 3>();
  EXPECT_GT(open.trace(), 0.05 * 0.05);
}

TEST(Score, TooFewFramesTellNothing) {
  const Both both({.frames = 3});
  const auto fit = both.fit(data::JointKind::ball);
  EXPECT_FALSE(fit.in_parent);
  EXPECT_FALSE(fit.in_child);
}

TEST(Score, UnitWeightsChangeNothing) {
  const Both both({.frames = 20, .noise_sd_m = 0.001});
  ScoreSums plain, weighted;
  for (const auto f : both.motion.frames) {
    plain.add(both.a, both.b, f);
    weighted.add(both.a, both.b, f, Eigen::Matrix3d::Identity());
  }
  EXPECT_LT((plain.normal - weighted.normal).norm(), 1e-12);
  EXPECT_LT((plain.right - weighted.right).norm(), 1e-12);
  EXPECT_NEAR(plain.squares, weighted.squares, 1e-12);
  ScoreSums none = plain;
  none -= plain;
  EXPECT_EQ(none.frames, 0.0);
}

}  // namespace
}  // namespace kinemark::skeleton
