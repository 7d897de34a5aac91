// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/segment_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

SegmentPoses first_segment(const testing::TestChain& chain, const SegmentPoseOptions& options = {}) {
  return find_segment_poses({chain.markers, {}}, "s0", chain.layout.segments[0].markers, options);
}

/// Distances between the markers of a shape, which no choice of axes changes.
double shape_error(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      worst = std::max(worst, std::abs((a.col(i) - a.col(j)).norm() - (b.col(i) - b.col(j)).norm()));
  return worst;
}

TEST(SegmentPoses, FindsShapeAndPosesThroughGapsExactly) {
  const auto chain = testing::make_chain({.per_segment = 6, .missing = 0.4});
  const auto poses = first_segment(chain);
  EXPECT_LT(shape_error(poses.x_in_segment, chain.x_in_segment[0]), 1e-8);
  EXPECT_EQ(poses.kind, data::SegmentKind::solid);
  EXPECT_GT(poses.known_frames, 200);
  EXPECT_LT(poses.noise_sd_m, 1e-8);
  for (std::size_t f = 0; f < poses.known.size(); ++f) {
    if (!poses.known[f]) continue;
    for (std::size_t k = 0; k < poses.markers.size(); ++k) {
      const auto frame = static_cast<std::int64_t>(f);
      if (!chain.markers.present(frame, poses.markers[k])) continue;
      const Eigen::Vector3d x = poses.to_world(frame, poses.x_in_segment.col(static_cast<Eigen::Index>(k)));
      EXPECT_LT((x - chain.markers.x(frame, poses.markers[k])).norm(), 1e-8);
    }
  }
}

TEST(SegmentPoses, EstimatesTheNoise) {
  const auto chain =
      testing::make_chain({.frames = 1000, .per_segment = 5, .noise_sd_m = 0.002, .missing = 0.2});
  const auto poses = first_segment(chain);
  EXPECT_NEAR(poses.noise_sd_m, 0.002, 1e-4);
  EXPECT_LT(shape_error(poses.x_in_segment, chain.x_in_segment[0]), 1e-3);
}

TEST(SegmentPoses, MarkersNeverSeenTogetherStillMakeOneShape) {
  auto chain = testing::make_chain({.per_segment = 8});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (std::int64_t m = 0; m < 8; ++m)
      if (f % 2 == 0 ? m > 5 : m < 3) chain.markers.set_missing(f, m);
  const auto poses = first_segment(chain);
  EXPECT_LT(shape_error(poses.x_in_segment, chain.x_in_segment[0]), 1e-7);
  EXPECT_EQ(poses.known_frames, chain.markers.frames());
  // With two in common the halves may rotate about the line through them: one half stays out.
  for (std::int64_t f = 0; f < chain.markers.frames(); f += 2) chain.markers.set_missing(f, 5);
  EXPECT_EQ(first_segment(chain).known_frames, chain.markers.frames() / 2);
}

TEST(SegmentPoses, MarkersOnALineHaveNoPose) {
  for (const double noise : {0.0, 0.002}) {
    const auto chain = testing::make_chain({.stagger_m = 0.0, .noise_sd_m = noise});
    const auto poses = first_segment(chain);
    EXPECT_EQ(poses.known_frames, 0);
    EXPECT_EQ(poses.kind, data::SegmentKind::line);
    EXPECT_EQ(poses.x_in_segment.topRows(2).norm(), 0.0);
  }
}

TEST(SegmentPoses, TwoMarkersLieOnZAtTheirDistance) {
  const auto chain = testing::make_chain({.per_segment = 2});
  const auto poses = first_segment(chain);
  EXPECT_EQ(poses.kind, data::SegmentKind::line);
  EXPECT_NEAR(poses.x_in_segment.col(0).z() - poses.x_in_segment.col(1).z(), std::hypot(0.05, 0.04), 1e-9);
}

TEST(SegmentPoses, FramesWithSwappedLabelsAreOddAndLeftOut) {
  auto chain = testing::make_chain({.per_segment = 4, .noise_sd_m = 0.0005});
  for (std::int64_t f = 100; f < 110; ++f) {
    const Eigen::Vector3d x = chain.markers.x(f, 0);
    chain.markers.x(f, 0) = chain.markers.x(f, 1);
    chain.markers.x(f, 1) = x;
  }
  const auto poses = first_segment(chain);
  EXPECT_EQ(poses.odd_frames, 10);
  EXPECT_EQ(poses.first_odd_frame, 100);
  EXPECT_GT(poses.odd_rms_m, 0.01);
  EXPECT_EQ(poses.known_frames, 290);
  EXPECT_LT(shape_error(poses.x_in_segment, chain.x_in_segment[0]), 5e-4);
}

TEST(SegmentPoses, MasksAreObeyed) {
  const auto chain = testing::make_chain({.per_segment = 4});
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(chain.markers.frames() * chain.markers.markers()),
                                 1);
  for (std::int64_t f = 0; f < 100; ++f)
    mask[chain.markers.index(f, 0)] = mask[chain.markers.index(f, 2)] = 0;
  const auto poses = find_segment_poses({chain.markers, mask}, "s0", chain.layout.segments[0].markers);
  EXPECT_EQ(poses.known_frames, 200);
  EXPECT_EQ(poses.known[99], 0);
}

TEST(SegmentPoses, NoiseOfAPointGrowsWithItsDistanceAsItReallyDoes) {
  const auto truth = testing::make_chain({.frames = 4000, .per_segment = 5});
  const auto noisy = testing::make_chain({.frames = 4000, .per_segment = 5, .noise_sd_m = 0.001});
  const Samples samples{noisy.markers, {}};
  const auto poses = first_segment(noisy, {.noise_sd_m = 0.001});
  const auto exact = first_segment(truth);
  for (const double z : {0.0, 0.3}) {
    const Eigen::Vector3d p(0.0, 0.0, z);
    double squares = 0.0, expected = 0.0;
    // The noisy shape's axes differ from the exact ones by a fixed small transform: take the mean off.
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::int64_t f = 0; f < 4000; ++f) mean += exact.to_segment(f, poses.to_world(f, p)) / 4000.0;
    for (std::int64_t f = 0; f < 4000; ++f) {
      squares += (exact.to_segment(f, poses.to_world(f, p)) - mean).squaredNorm();
      expected +=
          pose_noise(samples, poses, f).at(poses.world_from_segment[static_cast<std::size_t>(f)], p).trace();
    }
    EXPECT_NEAR(squares / expected, 1.0, 0.06) << z;
  }
}

}  // namespace
}  // namespace kinemark::skeleton
