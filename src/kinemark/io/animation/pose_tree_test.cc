// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/pose_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A trunk that turns about z, an arm 0.5 m above its origin, in two frames.
PoseTree two() {
  const Eigen::Matrix3d quarter = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  return {.bodies = {{.name = "trunk"}, {.name = "arm", .parent = 0}},
          .time = {.rate_hz = 100.0, .frames = 2},
          .world_from_body = {{.translation = {1, 0, 0}},
                              {.translation = {1, 0.5, 0}},
                              {quarter, {2, 0, 0}},
                              {quarter, {1.5, 0, 0}}}};
}

TEST(PoseTree, TellsPosesInTheAxesAbove) {
  const PoseTree poses = two();
  ASSERT_TRUE(poses.validate());
  EXPECT_LT((poses.pose_in_parent(1, 1).translation - Vector3d(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((poses.pose_in_parent(1, 1).rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_EQ(poses.pose_in_parent(1, 0).translation, Vector3d(2, 0, 0));
  EXPECT_TRUE(poses.moves_in_parent(0, 1e-9));
  EXPECT_FALSE(poses.moves_in_parent(1, 1e-9));
  EXPECT_THAT(poses.children(), ElementsAre(ElementsAre(1U), IsEmpty()));
}

TEST(PoseTree, RefusesWhatIsNone) {
  const auto wrong = [](auto change) {
    PoseTree poses = two();
    change(poses);
    const auto status = poses.validate();
    return status ? std::string("valid") : status.error().message;
  };
  EXPECT_THAT(wrong([](PoseTree& p) { p.bodies.clear(); }), HasSubstr("no body"));
  EXPECT_THAT(wrong([](PoseTree& p) { p.time.rate_hz = 0.0; }), HasSubstr("without a rate"));
  EXPECT_THAT(wrong([](PoseTree& p) { p.world_from_body.pop_back(); }), HasSubstr("3 poses of 2 bodies"));
  EXPECT_THAT(wrong([](PoseTree& p) { p.bodies[1].parent = 1; }), HasSubstr("'arm' comes before its parent"));
  EXPECT_THAT(wrong([](PoseTree& p) { p.bodies[1].name = "trunk"; }), HasSubstr("another's too"));
  EXPECT_THAT(wrong([](PoseTree& p) {
                p.world_from_body[2].translation.x() = std::numeric_limits<double>::quiet_NaN();
              }),
              HasSubstr("not finite"));
}

}  // namespace
}  // namespace kinemark::io
