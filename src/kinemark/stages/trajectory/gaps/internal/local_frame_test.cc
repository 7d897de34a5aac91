// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/local_frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

namespace kinemark::trajectory::internal {
namespace {

const std::vector<Index> kFrames = {0, 40, 90, 120};
const std::vector<double> kSd(5, 0.001);

TEST(LocalFrameTest, ARigidBodyStandsStillInIt) {
  const Recording r(testing::moving_bodies({.frames = 200}));
  const std::vector<Index> markers = {0, 1, 2, 3};
  const LocalFrame frame(r, markers, std::span(kSd).first(4), kFrames);
  ASSERT_TRUE(frame.has_rotation());
  const auto local = [&](Index marker, Index f) -> Eigen::Vector3d {
    const LocalPose p = frame.at(f);
    EXPECT_NEAR(p.R.determinant(), 1.0, 1e-12);
    return p.R.transpose() * (r.x(marker, f) - p.c);
  };
  for (Index f = 0; f < 200; f += 7) EXPECT_LT((local(4, f) - local(4, 0)).norm(), 1e-9) << f;
}

TEST(LocalFrameTest, TwoMarkersOrALineGiveAPositionOnly) {
  data::Trajectories t = testing::moving_bodies({.frames = 200});
  for (Index f = 0; f < 200; ++f) t.x(f, 2) = 0.5 * (t.x(f, 0) + t.x(f, 1));
  const Recording r(t);
  const std::vector<Index> two = {0, 1};
  const std::vector<Index> line = {0, 1, 2};
  EXPECT_FALSE(LocalFrame(r, two, std::span(kSd).first(2), kFrames).has_rotation());
  const LocalFrame frame(r, line, std::span(kSd).first(3), kFrames);
  EXPECT_FALSE(frame.has_rotation());
  EXPECT_TRUE(frame.at(50).R == Eigen::Matrix3d::Identity());
  EXPECT_LT((frame.at(50).c - 0.5 * (t.x(50, 0) + t.x(50, 1))).norm(), 1e-12);
}

}  // namespace
}  // namespace kinemark::trajectory::internal
