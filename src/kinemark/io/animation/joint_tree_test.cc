// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/joint_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
constexpr double kQuarter = std::numbers::pi / 2.0;

struct Placed {
  std::vector<Vector3d> x;
  std::vector<Eigen::Matrix3d> rotation;
};

Placed place(const JointTree& tree, const std::vector<double>& values) {
  Placed out{std::vector<Vector3d>(tree.joints.size()), std::vector<Eigen::Matrix3d>(tree.joints.size())};
  place_joints(tree, values, out.x, out.rotation);
  return out;
}

/// Root that moves and turns z, x, y; a hinge about x; a point.
JointTree arm() {
  return {
      {{.name = "root", .channels = {{false, 0}, {false, 1}, {false, 2}, {true, 2}, {true, 0}, {true, 1}}},
       {.name = "elbow", .parent = 0, .offset = {0, 2, 0}, .channels = {{true, 0}}},
       {.name = "hand", .parent = 1, .offset = {0, 3, 0}}}};
}

TEST(PlaceJoints, WithoutAnglesOffsetsAddUp) {
  const auto placed = place(arm(), {1, 2, 3, 0, 0, 0, 0});
  EXPECT_EQ(placed.x[0], Vector3d(1, 2, 3));
  EXPECT_EQ(placed.x[1], Vector3d(1, 4, 3));
  EXPECT_EQ(placed.x[2], Vector3d(1, 7, 3));
}

TEST(PlaceJoints, ChannelsTurnInTheirOrderEachAboutTheTurnedAxes) {
  // About z: the upper arm, along y, points to -x. Then about the new x, which is the world's y.
  const auto z = place(arm(), {0, 0, 0, kQuarter, 0, 0, 0});
  EXPECT_LT((z.x[1] - Vector3d(-2, 0, 0)).norm(), 1e-12);
  const auto zx = place(arm(), {0, 0, 0, kQuarter, kQuarter, 0, 0});
  EXPECT_LT((zx.x[1] - Vector3d(0, 0, 2)).norm(), 1e-12);
  const auto bent = place(arm(), {0, 0, 0, 0, 0, 0, kQuarter});
  EXPECT_LT((bent.x[2] - Vector3d(0, 2, 3)).norm(), 1e-12) << "the elbow takes the hand to the front";
}

TEST(PlaceJoints, IsAProductOfRotations) {
  Random random(3, 1);
  const auto angle = [&] { return 6.0 * random.uniform() - 3.0; };
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<double> v{0.3, -1.0, 2.0, angle(), angle(), angle(), angle()};
    const auto placed = place(arm(), v);
    using Eigen::AngleAxisd;
    const Eigen::Isometry3d root = Eigen::Translation3d(0.3, -1.0, 2.0) *
                                   AngleAxisd(v[3], Vector3d::UnitZ()) * AngleAxisd(v[4], Vector3d::UnitX()) *
                                   AngleAxisd(v[5], Vector3d::UnitY());
    const Eigen::Isometry3d elbow =
        root * Eigen::Translation3d(0, 2, 0) * AngleAxisd(v[6], Vector3d::UnitX());
    EXPECT_LT((placed.x[2] - elbow * Vector3d(0, 3, 0)).norm(), 1e-12);
    EXPECT_LT((placed.rotation[1] - elbow.linear()).norm(), 1e-12);
  }
}

TEST(PlaceJoints, AxesOfTheirOwnTurnWithTheAngles) {
  JointTree tree = arm();
  // The elbow's x is the world's z.
  tree.joints[1].axes = Eigen::AngleAxisd(-kQuarter, Vector3d::UnitY()).toRotationMatrix();
  const auto placed = place(tree, {0, 0, 0, 0, 0, 0, kQuarter});
  EXPECT_LT((placed.x[2] - Vector3d(-3, 2, 0)).norm(), 1e-12);
  EXPECT_LT((place(tree, {0, 0, 0, 0, 0, 0, 0}).x[2] - Vector3d(0, 5, 0)).norm(), 1e-12);
}

TEST(PlaceJoints, AboutFixedAxesTheOrderIsTheOtherOne) {
  JointTree fixed = arm(), turned = arm();
  fixed.joints[0].about_fixed_axes = true;
  turned.joints[0].channels = {{false, 0}, {false, 1}, {false, 2}, {true, 1}, {true, 0}, {true, 2}};
  const auto a = place(fixed, {0, 0, 0, 0.3, -0.8, 1.1, 0.5}),
             b = place(turned, {0, 0, 0, 1.1, -0.8, 0.3, 0.5});
  EXPECT_LT((a.x[2] - b.x[2]).norm(), 1e-12);
  EXPECT_GT((a.x[2] - place(arm(), {0, 0, 0, 0.3, -0.8, 1.1, 0.5}).x[2]).norm(), 0.1);
}

TEST(PlaceJoints, PositionsAddToTheOffsetOrStandForIt) {
  JointTree tree = arm();
  tree.joints[1].channels = {{false, 1}};
  EXPECT_EQ(place(tree, {0, 0, 0, 0, 0, 0, 10}).x[1], Vector3d(0, 12, 0));
  tree.joints[1].stands_for_offset = true;
  EXPECT_EQ(place(tree, {0, 0, 0, 0, 0, 0, 10}).x[1], Vector3d(0, 10, 0));
}

TEST(PlaceJoints, WantsANumberForEveryChannelAndRoomForEveryJoint) {
  EXPECT_EQ(arm().channel_count(), 7U);
  EXPECT_ANY_THROW(place(arm(), {0, 0, 0}));
  std::vector<Vector3d> x(1);
  std::vector<Eigen::Matrix3d> rotation(3);
  EXPECT_ANY_THROW(place_joints(arm(), std::vector<double>(7), x, rotation));
}

}  // namespace
}  // namespace kinemark::io
