// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/cluster.h"

#include <gtest/gtest.h>

#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::internal {
namespace {

testing::TestChain without(std::int64_t frames_missing) {
  auto chain = testing::make_swings({.noise_sd_m = 0.0});
  for (std::int64_t f = 0; f < frames_missing; ++f)
    chain.markers.state[chain.markers.index(f, 5)] = data::SampleState::missing;
  return chain;
}

TEST(Cluster, HasEveryMarkerAndFrameWhereNothingIsMissing) {
  const testing::JointSetup setup(without(0));
  const auto pair = find_clusters(setup.samples, setup.parent, setup.child, setup.task.motion);
  EXPECT_EQ(pair.parent.columns.size(), 4U);
  EXPECT_EQ(pair.child.columns.size(), 4U);
  EXPECT_EQ(pair.frames.size(), 800U);
  EXPECT_EQ(pair.child.freedom(), 6.0);
  EXPECT_LT(pair.child.mean.norm(), 1e-9) << "a segment's origin is the mean of its markers";
}

TEST(Cluster, LeavesOutAMarkerThatIsSeldomSeenOrElseTheFramesWithoutIt) {
  const testing::JointSetup seldom(without(300));
  const auto few = find_clusters(seldom.samples, seldom.parent, seldom.child, seldom.task.motion);
  EXPECT_EQ(few.child.columns.size(), 3U);
  EXPECT_EQ(few.frames.size(), 800U);
  const testing::JointSetup often(without(100));
  const auto most = find_clusters(often.samples, often.parent, often.child, often.task.motion);
  EXPECT_EQ(most.child.columns.size(), 4U);
  EXPECT_EQ(most.frames.size(), 700U);
}

TEST(Cluster, RigidMarkersDoNotDeformAndSlidingOnesDo) {
  for (const double slide_m : {0.0, 0.01}) {
    const testing::JointSetup setup(testing::make_swings({.noise_sd_m = 0.0, .own_slide_m = slide_m}));
    const auto pair = find_clusters(setup.samples, setup.parent, setup.child, setup.task.motion);
    const Eigen::MatrixXd off = deformation(setup.samples, setup.child, pair.child, pair.frames);
    ASSERT_EQ(off.rows(), 800);
    ASSERT_EQ(off.cols(), 12);
    EXPECT_LT(off.colwise().mean().norm(), 1e-12);
    if (slide_m > 0.0)
      EXPECT_GT(off.norm() / std::sqrt(800.0), 0.003);
    else
      EXPECT_LT(off.norm() / std::sqrt(800.0), 1e-6);
  }
}

}  // namespace
}  // namespace kinemark::skeleton::internal
