// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/geometry/fit_rounds.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using data::SegmentKind;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

GlobalFrames true_poses(const RandomChain& limb) {
  GlobalFrames frames;
  for (std::size_t f = 0; f < limb.pose.size(); ++f) {
    frames.frame.push_back(static_cast<std::int64_t>(f));
    frames.pose.push_back(limb.pose[f]);
    frames.weight.emplace_back(limb.chain.markers(), 1.0);
  }
  return frames;
}

TEST(GlobalFit, ReturnsToTheGeometryOfExactData) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb =
        make_random_chain({.segments = 3, .frames = 40, .kind = kind, .noise_sd_m = 0.0, .missing = 0.1});
    Chain chain = limb.chain;
    Random random(3, 1);
    Eigen::VectorXd step(static_cast<Eigen::Index>(chain.globals().size()));
    for (double& s : step) s = 0.003 * random.gaussian();
    chain.add_globals(step);
    GlobalFrames frames = true_poses(limb);
    GlobalFit fit(chain, limb.samples, frames);
    EXPECT_GT(fit.cost(), 1e-4);
    EXPECT_LT(fit.run(30), 1e-12);
    for (int k = 0; k < chain.markers(); ++k)
      EXPECT_NEAR(chain.marker.col(k).norm(), limb.chain.marker.col(k).norm(), 1e-6);
    EXPECT_NEAR(chain.joint.col(1).norm(), limb.chain.joint.col(1).norm(), 1e-6);
  }
}

TEST(GlobalFit, DegreesOfFreedomAreCounted) {
  RandomChain limb = make_random_chain({.frames = 20});
  GlobalFrames frames = true_poses(limb);
  // 18 coordinates and 9 parameters a frame; 18 places of markers less 6 turns of axes.
  EXPECT_EQ(GlobalFit(limb.chain, limb.samples, frames).degrees_of_freedom(), 20 * 9 - 18 + 6);
  // One marker on the first segment: 12 coordinates, and its turn about the line to the joint is open.
  for (const int k : {1, 2}) hide(limb.samples, 0, k);
  EXPECT_EQ(GlobalFit(limb.chain, limb.samples, frames).degrees_of_freedom(), 19 * 9 + (12 - 8) - 18 + 6);
}

// How far the first marker lies from the joint: its scatter over recordings against its variance in each.
TEST(GlobalFit, CovarianceIsThatOfRepeatedRecordings) {
  constexpr double kNoise_m = 0.001;
  constexpr int kRecordings = 60;
  double sum = 0.0, squares = 0.0, variance = 0.0, chi2 = 0.0;
  for (int round = 0; round < kRecordings; ++round) {
    RandomChain limb = make_random_chain(
        {.frames = 25, .noise_sd_m = kNoise_m, .seed = static_cast<std::uint64_t>(round) + 1});
    const double truth = limb.chain.marker.col(0).norm();
    GlobalFrames frames = true_poses(limb);
    GlobalFit fit(limb.chain, limb.samples, frames);
    chi2 += fit.run(10) / (kNoise_m * kNoise_m * fit.degrees_of_freedom()) / kRecordings;
    const Eigen::MatrixXd C = kNoise_m * kNoise_m * fit.covariance(kNoise_m);
    const Vector3d way = limb.chain.marker.col(0).normalized();
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(C.rows());
    slope.head<3>() = way;  // the first marker's globals come first
    variance += slope.dot(C * slope) / kRecordings;
    const double error = limb.chain.marker.col(0).norm() - truth;
    sum += error;
    squares += error * error / kRecordings;
    EXPECT_LT((C * limb.chain.gauge()).norm(), 1e-9 * C.norm());
  }
  EXPECT_NEAR(chi2, 1.0, 0.03);
  EXPECT_LT(std::abs(sum / kRecordings), 4.0 * std::sqrt(variance / kRecordings));
  EXPECT_NEAR(squares / variance, 1.0, 0.45);
}

TEST(GlobalFit, EachMarkersNoiseIsSeenInItsResiduals) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 150});
  Random skin(8, 1);
  for (std::size_t f = 0; f < 150; ++f)
    for (std::size_t i = 0; i < 3; ++i) limb.samples.x[30 * f + 3 * 6 + i] += 0.003 * skin.gaussian();
  GlobalFrames frames = true_poses(limb);
  GlobalFit fit(limb.chain, limb.samples, frames);
  (void)fit.run(5);
  const auto ratio = fit.marker_variance(0.001);
  for (std::size_t k = 0; k < 10; ++k) {
    if (k == 6) {
      EXPECT_GT(ratio[k], 2.5) << "drawn towards 1, and its segment drawn towards it";
      EXPECT_LT(ratio[k], 10.0);
    } else {
      EXPECT_LT(ratio[k], 1.8) << k;
    }
  }
  // Student's weights fall with the distance and never rise above one.
  fit.reweigh(std::vector<double>(10, 1.0), 5.0, 0.001);
  double loose = 0.0, others = 0.0;
  for (const auto& weight : frames.weight) {
    loose += weight[6] / 150.0;
    for (std::size_t k = 0; k < 5; ++k) others += weight[k] / 750.0;
    for (const double w : weight) EXPECT_LE(w, 1.0);
  }
  EXPECT_LT(loose, 0.8 * others);
}

TEST(ThinOut, DrawsEvenlyAndOnlyFramesThatShowTwoMarkers) {
  RandomChain limb = make_random_chain({.frames = 100});
  for (int f = 0; f < 50; ++f)
    for (int k = 0; k < 5; ++k) hide(limb.samples, f, k);
  std::vector<std::int64_t> kept;
  const ChainSamples all = thin_out(limb.samples, 1000, kept);
  EXPECT_EQ(all.frames, 50);
  EXPECT_EQ(kept.front(), 50);
  const ChainSamples some = thin_out(limb.samples, 10, kept);
  ASSERT_EQ(kept.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(kept[i], 50 + 5 * static_cast<std::int64_t>(i));
    EXPECT_EQ(some.frame(static_cast<std::int64_t>(i))[0], limb.samples.frame(kept[i])[0]);
  }
}

TEST(FirstFrames, PrefersWholeFramesAndMakesDoWithFewer) {
  RandomChain limb = make_random_chain({.frames = 100});
  for (int f = 0; f < 40; ++f) hide(limb.samples, f, 1);
  EXPECT_EQ(first_frames(limb.samples, limb.chain).size(), 60U) << "whole frames, if forty or more";
  for (int f = 40; f < 80; ++f) hide(limb.samples, f, 4);
  EXPECT_EQ(first_frames(limb.samples, limb.chain).size(), 100U) << "three of one and two of the other";
}

// Poses that turn about all axes leave one geometry: no twin is looked for.
TEST(TryTwins, NoTwinWhereTheJointTurnsFreely) {
  const RandomChain limb = make_random_chain({.frames = 80});
  ChainFit fit;
  fit.chain = limb.chain;
  fit.noise_sd_m = 0.001;
  fit.marker_weight.assign(6, 1.0);
  EXPECT_FALSE(try_twins(limb.samples, true_poses(limb), fit));
  EXPECT_TRUE(std::isinf(fit.twin_margin));
}

}  // namespace
}  // namespace kinemark::skeleton
