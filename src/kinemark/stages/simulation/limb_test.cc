// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/limb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

Vector3d true_marker(const LimbRecording& limb, std::int64_t frame, std::int64_t marker) {
  return Eigen::Map<const Vector3d>(limb.x_true.data() + 3 * limb.markers.index(frame, marker));
}

Vector3d centre(const LimbRecording& limb, std::int64_t frame, std::size_t joint) {
  const std::size_t joints = limb.layout.joints.size();
  return Eigen::Map<const Vector3d>(limb.centre_in_world.data() +
                                    3 * (static_cast<std::size_t>(frame) * joints + joint));
}

TEST(SimulateChain, KeepsLengthsInEveryFrame) {
  ChainOptions options;
  options.lengths_m = {0.1, 0.2, 0.15};
  options.frames = 50;
  options.stagger_m = 0.02;
  const auto limb = simulate_chain(options);
  ASSERT_TRUE(limb) << limb.error().message;
  ASSERT_TRUE(limb->markers.validate());
  ASSERT_TRUE(limb->layout.validate(limb->markers.markers()));
  EXPECT_EQ(limb->markers.markers(), 9);
  EXPECT_EQ(limb->layout.segments[2].name, "s2");
  EXPECT_EQ(limb->layout.joints[1].name, "j1");
  EXPECT_EQ(limb->layout.joints[1].parent, 1);
  EXPECT_EQ(limb->markers.names[7], "s2m1");
  for (std::int64_t f = 0; f < 50; ++f) {
    EXPECT_NEAR(centre(*limb, f, 0).norm(), 0.1, 1e-12);
    EXPECT_NEAR((centre(*limb, f, 1) - centre(*limb, f, 0)).norm(), 0.2, 1e-12);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < a; ++b) {
        const auto& positions = limb->x_in_segment[1];
        EXPECT_NEAR((true_marker(*limb, f, 3 + a) - true_marker(*limb, f, 3 + b)).norm(),
                    (positions.col(a) - positions.col(b)).norm(), 1e-12);
      }
    // Segment axes start at the upper joint.
    EXPECT_NEAR((true_marker(*limb, f, 4) - centre(*limb, f, 0)).norm(), limb->x_in_segment[1].col(1).norm(),
                1e-12);
  }
}

TEST(SimulateChain, HasMarkersAtEvenSteps) {
  ChainOptions options;
  options.frames = 1;
  const auto line = simulate_chain(options).value();
  EXPECT_LT((line.x_in_segment[0].col(1) - Vector3d(0, 0, 0.075)).norm(), 1e-15);
  EXPECT_LT((line.x_in_segment[1].col(2) - Vector3d(0, 0, 0.12)).norm(), 1e-15);
  options.stagger_m = 0.02;
  const auto solid = simulate_chain(options).value();
  EXPECT_NEAR(solid.x_in_segment[0].col(1).head<2>().norm(), 0.02, 1e-15);
  EXPECT_LT(solid.x_in_segment[0].topRows<2>().rowwise().sum().norm(), 1e-15);  // all around the bone
  options.planar = true;
  const auto plane = simulate_chain(options).value();
  EXPECT_EQ(plane.x_in_segment[0].row(1).norm(), 0.0);
  EXPECT_NEAR(plane.x_in_segment[0](0, 0), 0.02, 1e-15);
  EXPECT_NEAR(plane.x_in_segment[0](0, 1), -0.02, 1e-15);
}

TEST(SimulateChain, PointsEverywhereAlike) {
  ChainOptions options;
  options.frames = 4000;
  options.stagger_m = 0.02;
  const auto limb = simulate_chain(options).value();
  Vector3d mean = Vector3d::Zero(), forearm = Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::int64_t f = 0; f < 4000; ++f) {
    const Vector3d along = centre(limb, f, 0) / 0.15;
    mean += along / 4000.0;
    spread += along * along.transpose() / 4000.0;
    forearm += (true_marker(limb, f, 4) - centre(limb, f, 0)) / 4000.0;
  }
  EXPECT_LT(mean.norm(), 0.04);
  EXPECT_LT((spread - Eigen::Matrix3d::Identity() / 3.0).norm(), 0.04);
  EXPECT_LT(forearm.norm(), 0.005);
}

TEST(SimulateChain, NoiseAndLossesAreAsAsked) {
  ChainOptions options;
  options.frames = 3000;
  options.noise_sd_m = 0.002;
  options.missing = 0.4;
  const auto limb = simulate_chain(options).value();
  double squares = 0.0;
  int seen = 0;
  for (std::int64_t f = 0; f < 3000; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      if (!limb.markers.present(f, m)) continue;
      squares += (limb.markers.x(f, m) - true_marker(limb, f, m)).squaredNorm();
      ++seen;
    }
  EXPECT_NEAR(seen / 18000.0, 0.6, 0.012);
  EXPECT_NEAR(std::sqrt(squares / (3.0 * seen)), 0.002, 5e-5);
}

TEST(SimulateChain, MarkersMayGoUpToTheEnd) {
  ChainOptions options;
  options.last_at_end = true;
  const auto thirds = simulate_chain(options).value();
  EXPECT_NEAR(thirds.x_in_segment[0](2, 0), 0.05, 1e-12);
  EXPECT_NEAR(thirds.x_in_segment[0](2, 2), 0.15, 1e-12);
  options.last_at_end = false;
  EXPECT_NEAR(simulate_chain(options).value().x_in_segment[0](2, 2), 0.1125, 1e-12);
}

TEST(SimulateChain, LossesMayGoWithThePose) {
  ChainOptions options;
  options.frames = 4000;
  options.missing = 0.3;
  options.pose_correlated = true;
  const auto limb = simulate_chain(options).value();
  EXPECT_NEAR(static_cast<double>(limb.markers.count_missing()) / 24000.0, 0.3, 0.02);
  const Vector3d side = Vector3d(0.36, 0.53, 0.77).normalized();
  double lost_near = 0.0, near = 0.0, lost_far = 0.0, far = 0.0;
  for (std::int64_t f = 0; f < 4000; ++f) {
    const Vector3d end = Eigen::Map<const Vector3d>(limb.end_in_world.data() + 3 * f);
    EXPECT_NEAR((end - centre(limb, f, 0)).norm(), 0.16, 1e-12);
    const double cosine = end.normalized().dot(side);
    for (std::int64_t m = 0; m < 6; ++m) {
      const double lost = limb.markers.present(f, m) ? 0.0 : 1.0;
      if (cosine > 0.9) near += 1.0, lost_near += lost;
      if (cosine < -0.9) far += 1.0, lost_far += lost;
    }
  }
  EXPECT_NEAR(lost_near / near, 0.585, 0.06);
  EXPECT_LT(lost_far / far, 0.04);
}

TEST(SimulateChain, NoiseAndLossesLeaveTheMotionAlone) {
  ChainOptions options;
  options.frames = 20;
  options.seed = 9;
  const auto plain = simulate_chain(options).value();
  options.missing = 0.5;
  const auto lossy = simulate_chain(options).value();
  EXPECT_EQ(plain.x_true, lossy.x_true);
  for (std::int64_t f = 0; f < 20; ++f)
    for (std::int64_t m = 0; m < 6; ++m)
      if (lossy.markers.present(f, m)) {
        EXPECT_EQ(lossy.markers.x(f, m), plain.markers.x(f, m));
      }
  options.noise_sd_m = 0.0;
  options.missing = 0.0;
  const auto clean = simulate_chain(options).value();
  EXPECT_EQ(clean.markers.x_in_world, clean.x_true);
  options.seed = 10;
  EXPECT_NE(simulate_chain(options).value().x_true, clean.x_true);
}

TEST(SimulateChain, RefusesWhatItCannotDraw) {
  const auto refused = [](auto change, const char* word) {
    ChainOptions options;
    change(options);
    const auto limb = simulate_chain(options);
    ASSERT_FALSE(limb);
    EXPECT_EQ(limb.error().code, Code::usage);
    EXPECT_THAT(limb.error().message, HasSubstr(word));
  };
  refused([](ChainOptions& o) { o.frames = 0; }, "frames");
  refused([](ChainOptions& o) { o.lengths_m = {0.1}; }, "segments");
  refused([](ChainOptions& o) { o.lengths_m = {0.1, -0.1}; }, "length");
  refused([](ChainOptions& o) { o.markers_per_segment = 0; }, "markers_per_segment");
  refused([](ChainOptions& o) { o.stagger_m = -1.0; }, "stagger_m");
  refused([](ChainOptions& o) { o.noise_sd_m = std::nan(""); }, "noise_sd_m");
  refused([](ChainOptions& o) { o.missing = 1.0; }, "missing");
  refused([](ChainOptions& o) { o.rate_hz = 0.0; }, "rate_hz");
  refused([](ChainOptions& o) { o.frames = 10'000'000, o.markers_per_segment = 60; }, "frames x markers");
}

}  // namespace
}  // namespace kinemark::simulation
