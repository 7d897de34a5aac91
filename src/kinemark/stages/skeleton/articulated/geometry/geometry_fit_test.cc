// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/true_poses.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::move_as_hinge;
using testing_limbs::RandomChain;
using testing_limbs::true_poses;

TEST(GeometryFit, ReturnsToTheGeometryOfExactData) {
  for (const SegmentKind kind : {SegmentKind::line, SegmentKind::plane, SegmentKind::solid}) {
    const RandomChain limb =
        make_random_chain({.segments = 3, .frames = 40, .kind = kind, .noise_sd_m = 0.0, .missing = 0.1});
    Chain chain = limb.chain;
    Random random(3, 1);
    Eigen::VectorXd step(static_cast<Eigen::Index>(chain.geometry_parameters().size()));
    for (double& s : step) s = 0.003 * random.gaussian();
    chain.move_geometry(step);
    PosedFrames frames = true_poses(limb);
    GeometryFit fit(chain, limb.samples, frames);
    EXPECT_GT(fit.cost(), 1e-4);
    EXPECT_LT(fit.run(30), 1e-12);
    for (int k = 0; k < chain.markers(); ++k)
      EXPECT_NEAR(chain.marker.col(k).norm(), limb.chain.marker.col(k).norm(), 1e-6);
    EXPECT_NEAR(chain.joint.col(1).norm(), limb.chain.joint.col(1).norm(), 1e-6);
  }
}

TEST(GeometryFit, DegreesOfFreedomAreCounted) {
  RandomChain limb = make_random_chain({.frames = 20});
  PosedFrames frames = true_poses(limb);
  // 18 coordinates and 9 parameters a frame; 18 positions of markers less 6 turns of axes.
  EXPECT_EQ(GeometryFit(limb.chain, limb.samples, frames).degrees_of_freedom(), 20 * 9 - 18 + 6);
  // One marker on the first segment: 12 coordinates, and its turn about the line to the joint is open.
  for (const int k : {1, 2}) hide(limb.samples, 0, k);
  EXPECT_EQ(GeometryFit(limb.chain, limb.samples, frames).degrees_of_freedom(), 19 * 9 + (12 - 8) - 18 + 6);
}

// How far the first marker lies from the joint: its scatter over recordings against its variance in each.
TEST(GeometryFit, CovarianceIsThatOfRepeatedRecordings) {
  constexpr double kNoise_m = 0.001;
  constexpr int kRecordings = 60;
  double sum = 0.0, squares = 0.0, variance = 0.0, chi2 = 0.0;
  for (int round = 0; round < kRecordings; ++round) {
    RandomChain limb = make_random_chain(
        {.frames = 25, .noise_sd_m = kNoise_m, .seed = static_cast<std::uint64_t>(round) + 1});
    const double truth = limb.chain.marker.col(0).norm();
    PosedFrames frames = true_poses(limb);
    GeometryFit fit(limb.chain, limb.samples, frames);
    chi2 += fit.run(10) / (kNoise_m * kNoise_m * fit.degrees_of_freedom()) / kRecordings;
    const Eigen::MatrixXd C = kNoise_m * kNoise_m * fit.covariance(kNoise_m);
    const Vector3d direction = limb.chain.marker.col(0).normalized();
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(C.rows());
    slope.head<3>() = direction;  // the first marker's coordinates come first
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

TEST(GeometryFit, EachMarkersNoiseIsSeenInItsResiduals) {
  RandomChain limb = make_random_chain({.markers_per_segment = 5, .frames = 150});
  Random skin(8, 1);
  for (std::size_t f = 0; f < 150; ++f)
    for (std::size_t i = 0; i < 3; ++i) limb.samples.x[30 * f + 3 * 6 + i] += 0.003 * skin.gaussian();
  PosedFrames frames = true_poses(limb);
  GeometryFit fit(limb.chain, limb.samples, frames);
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

// Half the cost's slope by differences, every pose refitted, against the step that the fit takes from there.
TEST(GeometryFit, EndsWhereTheCostIsLeast) {
  RandomChain limb = make_random_chain({.frames = 30, .noise_sd_m = 0.002});
  PosedFrames frames = true_poses(limb);
  GeometryFit fit(limb.chain, limb.samples, frames);
  const double least = fit.run(30);
  const auto n = static_cast<Eigen::Index>(limb.chain.geometry_parameters().size());
  Random random(12, 1);
  for (int round = 0; round < 5; ++round) {
    Eigen::VectorXd step(n);
    for (double& s : step) s = 1e-3 * random.gaussian();
    limb.chain.move_geometry(step);
    EXPECT_GE(fit.cost(), least * (1.0 - 1e-9));
    limb.chain.move_geometry(-step);
  }
  EXPECT_NEAR(fit.cost(), least, 1e-6 * least);
}

// A hinge leaves the position along its axis open: its variance is that of the prior, 0.3 m, or of a hold.
TEST(GeometryFit, TheOpenDirectionOfAHingeIsWide) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 60});
  move_as_hinge(limb, 0.0);  // noise would look like motion about other axes
  PosedFrames frames = true_poses(limb);
  GeometryFit fit(limb.chain, limb.samples, frames, 0.0005);
  (void)fit.run(10);
  Eigen::VectorXd along =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(limb.chain.geometry_parameters().size()));
  for (std::size_t g = 0; g < limb.chain.geometry_parameters().size(); ++g)
    if (limb.chain.geometry_parameters()[g].axis == 0) along[static_cast<Eigen::Index>(g)] = -1.0;
  along.normalize();
  const double open = 0.0005 * std::sqrt(along.dot(fit.covariance(0.0005) * along));
  EXPECT_GT(open, 0.05);
  fit.hold({{.joint = 0, .in_parent = Vector3d::UnitX(), .in_child = Vector3d::UnitX()}});
  (void)fit.run(10);
  EXPECT_LT(0.0005 * std::sqrt(along.dot(fit.covariance(0.0005) * along)), 0.1 * open);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
