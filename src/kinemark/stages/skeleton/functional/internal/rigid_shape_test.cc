// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/rigid_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::internal {
namespace {

using testing::make_chain;
using testing::TestChain;

/// Largest error of the distances between markers: no choice of axes changes it.
double distance_error(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& truth) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < truth.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      worst = std::max(worst,
                       std::abs((found.col(i) - found.col(j)).norm() - (truth.col(i) - truth.col(j)).norm()));
  return worst;
}

Eigen::Matrix3Xd find_shape(const TestChain& chain) {
  const Samples samples{chain.markers, {}};
  RigidShape shape(samples, chain.layout.segments[0].markers);
  EXPECT_TRUE(shape.find());
  return shape.positions();
}

TEST(RigidShape, IsExactOnExactDataWithGaps) {
  const TestChain chain = make_chain({.frames = 120, .per_segment = 5, .missing = 0.25});
  const Eigen::Matrix3Xd found = find_shape(chain);
  EXPECT_LT(distance_error(found, chain.x_in_segment[0]), 1e-6);
  EXPECT_LT(found.rowwise().mean().norm(), 1e-12) << "origin at the mean";
  EXPECT_GT(found.row(2).norm(), found.row(0).norm()) << "z along the longest extent";
  EXPECT_GT(found.row(0).norm(), found.row(1).norm()) << "y along the least";
}

TEST(RigidShape, ErrsLessTheMoreFramesThereAre) {
  const auto error = [](std::int64_t frames) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const TestChain chain = make_chain(
          {.frames = frames, .per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.002, .seed = seed});
      sum += distance_error(find_shape(chain), chain.x_in_segment[0]) / 4.0;
    }
    return sum;
  };
  const double few = error(50), many = error(1250);
  EXPECT_LT(few, 0.003);
  EXPECT_LT(many, 0.5 * few);
}

TEST(RigidShape, DoesNotChangeWithTheRoom) {
  TestChain chain = make_chain({.frames = 60, .per_segment = 4, .noise_sd_m = 0.001, .missing = 0.1});
  const Eigen::Matrix3Xd before = find_shape(chain);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (std::int64_t m = 0; m < chain.markers.markers(); ++m)
      if (chain.markers.present(f, m))
        chain.markers.x(f, m) = (R * chain.markers.x(f, m)).eval() + Eigen::Vector3d(2.0, 1.0, -3.0);
  EXPECT_LT((find_shape(chain) - before).norm(), 1e-6);
}

TEST(RigidShape, PosesPutTheShapeOntoTheMarkers) {
  const TestChain chain = make_chain({.frames = 40, .per_segment = 4});
  const std::vector<int>& markers = chain.layout.segments[1].markers;
  const Samples samples{chain.markers, {}};
  RigidShape shape(samples, markers);
  ASSERT_TRUE(shape.find());
  for (std::int64_t f = 0; f < 40; ++f) {
    const FramePose pose = shape.pose(f);
    EXPECT_EQ(pose.visible, 4);
    EXPECT_NEAR(pose.rotation.determinant(), 1.0, 1e-12);
    EXPECT_LT(pose.squares, 1e-14);
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d x =
          pose.rotation * shape.positions().col(static_cast<Eigen::Index>(k)) + pose.origin;
      EXPECT_LT((x - chain.markers.x(f, markers[k])).norm(), 1e-7);
    }
  }
}

TEST(RigidShape, AMarkerThatIsElsewhereInFewFramesDoesNotChangeTheShape) {
  TestChain chain = make_chain({.frames = 200, .per_segment = 5, .stagger_m = 0.03, .noise_sd_m = 0.0005});
  for (std::int64_t f = 0; f < 10; ++f) chain.markers.x(f, 2) += Eigen::Vector3d(0.2, 0.0, 0.0);
  EXPECT_LT(distance_error(find_shape(chain), chain.x_in_segment[0]), 0.001);
}

TEST(RigidShape, TwoMarkersAFrameAreNone) {
  TestChain chain = make_chain({.frames = 20});
  for (std::int64_t f = 0; f < 20; ++f) chain.markers.set_missing(f, f % 3);
  const Samples samples{chain.markers, {}};
  RigidShape shape(samples, chain.layout.segments[0].markers);
  EXPECT_FALSE(shape.find());
  EXPECT_TRUE(shape.positions().hasNaN());
  shape.set_positions(chain.x_in_segment[0]);
  EXPECT_LT(shape.pose(0).visible, 3) << "and no pose of a known shape";
}

TEST(RigidShape, MarkersOnALineHaveNoInertiaAboutIt) {
  const TestChain line = make_chain({.frames = 20, .stagger_m = 0.0}), wide = make_chain({.frames = 20});
  const Samples on_line_samples{line.markers, {}};
  RigidShape on_line(on_line_samples, line.layout.segments[0].markers);
  const Samples off_line_samples{wide.markers, {}};
  RigidShape off_line(off_line_samples, wide.layout.segments[0].markers);
  ASSERT_TRUE(on_line.find());
  ASSERT_TRUE(off_line.find());
  EXPECT_EQ(on_line.least_inertia(), 0.0);
  EXPECT_GT(off_line.least_inertia(), 1e-5);
}

// Two unit masses at +-1 on x: 2 about y and z, none about x.
TEST(Inertia, OfADumbbellIsKnown) {
  const Eigen::Matrix3d scatter = Eigen::Vector3d(2.0, 0.0, 0.0).asDiagonal();
  EXPECT_LT((inertia(scatter) - Eigen::Matrix3d(Eigen::Vector3d(0.0, 2.0, 2.0).asDiagonal())).norm(), 1e-15);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
