// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinemark/core/check.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing_limbs::make_random_chain;
using testing_limbs::random_rotation;

TEST(Chain, NearestRotationUndoesARotation) {
  Random random(2, 1);
  for (int round = 0; round < 20; ++round) {
    const Matrix3d R = random_rotation(random);
    Matrix3d scatter = Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      Vector3d m;
      for (int i = 0; i < 3; ++i) m[i] = random.gaussian();
      scatter += R * m * m.transpose();
    }
    EXPECT_LT((nearest_rotation(scatter) - R).norm(), 1e-9);
  }
}

TEST(Chain, NearestRotationIsProperWhenThePointsAreMirrored) {
  const Matrix3d mirrored = Vector3d(1.0, 2.0, -3.0).asDiagonal();
  EXPECT_NEAR(nearest_rotation(mirrored).determinant(), 1.0, 1e-12);
}

TEST(Chain, WalksDownABranchedTree) {
  // Joints: 0 between segments 0 and 1, 1 between 0 and 2, 2 between 2 and 3.
  Chain chain({.parent = {0, 0, 2}, .segment_of_marker = {0, 1, 2, 3}},
              std::vector<SegmentKind>(4, SegmentKind::solid));
  chain.joint.col(1) = Vector3d(0.0, 0.3, 0.0);
  chain.joint.col(2) = Vector3d(0.1, 0.0, 0.0);
  chain.marker.col(3) = Vector3d(0.0, 0.0, 0.2);
  EXPECT_EQ(chain.frame_parameters(), 15);
  EXPECT_EQ(chain.geometry_parameters().size(), 18u);
  EXPECT_TRUE(chain.joints_to(1).empty());
  EXPECT_EQ(chain.joints_to(3), (std::vector<int>{1, 2}));
  ChainPose pose{.joint0 = {1.0, 0.0, 0.0}, .rotation = std::vector<Matrix3d>(4, Matrix3d::Identity())};
  pose.rotation[0] = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT((chain.joint_centre(pose, 1) - Vector3d(0.7, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((chain.joint_centre(pose, 2) - Vector3d(0.8, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((chain.predict(pose, 3) - Vector3d(0.8, 0.0, 0.2)).norm(), 1e-12);
  EXPECT_LT((chain.origin(pose, 1) - pose.joint0).norm(), 1e-15);
}

TEST(Chain, CountsParametersByKind) {
  const ChainLayout layout{.parent = {0, 1}, .segment_of_marker = {0, 0, 1, 1, 2}};
  const Chain chain(layout, {SegmentKind::line, SegmentKind::plane, SegmentKind::solid});
  EXPECT_EQ(chain.frame_parameters(), 3 + 2 + 3 + 3);
  EXPECT_EQ(chain.geometry_parameters().size(), 2u + 4u + 3u + 2u);  // joint 1 lies in the plane of segment 1
}

TEST(Chain, RefusesAnOrderWhereChildrenComeFirst) {
  const ChainLayout layout{.parent = {0, 2}, .segment_of_marker = {0, 1, 2}};
  EXPECT_THROW(Chain(layout, std::vector<SegmentKind>(3, SegmentKind::solid)), ContractError);
}

// A gauge step turns a segment's points about its origin: to first order no distance to the origin changes,
// nor between the segment's points.
TEST(Chain, GaugeOnlyTurnsAxes) {
  for (const SegmentKind kind : {SegmentKind::plane, SegmentKind::solid}) {
    const auto limb = make_random_chain({.segments = 3, .kind = kind});
    const Eigen::MatrixXd gauge = limb.chain.gauge();
    EXPECT_EQ(gauge.cols(), kind == SegmentKind::solid ? 9 : 3);
    EXPECT_LT((gauge.transpose() * gauge - Eigen::MatrixXd::Identity(gauge.cols(), gauge.cols())).norm(),
              1e-12);
    for (Eigen::Index c = 0; c < gauge.cols(); ++c) {
      Chain rotated = limb.chain;
      rotated.move_geometry(1e-6 * gauge.col(c));
      for (int a = 0; a < rotated.markers(); ++a) {
        EXPECT_NEAR(rotated.marker.col(a).norm(), limb.chain.marker.col(a).norm(), 1e-10);
        for (int b = 0; b < a; ++b) {
          if (rotated.layout.segment_of_marker[a] != rotated.layout.segment_of_marker[b]) continue;
          EXPECT_NEAR((rotated.marker.col(a) - rotated.marker.col(b)).norm(),
                      (limb.chain.marker.col(a) - limb.chain.marker.col(b)).norm(), 1e-10);
        }
      }
    }
  }
}

TEST(Chain, CanonicalAxesKeepAFlatSegmentsShape) {
  auto limb = make_random_chain({.segments = 3, .kind = SegmentKind::plane});
  Chain rotated = limb.chain;
  Random random(3, 1);
  const Matrix3d R = random_rotation(random);
  rotated.marker = (R * rotated.marker).eval();
  rotated.joint = (R * rotated.joint).eval();
  make_canonical(rotated);
  EXPECT_LT(rotated.marker.row(1).norm(), 1e-12);
  for (int k = 0; k < rotated.markers(); ++k) {
    EXPECT_NEAR(rotated.marker.col(k).norm(), limb.chain.marker.col(k).norm(), 1e-12);
  }
  EXPECT_NEAR(rotated.joint.col(1).dot(rotated.marker.col(4)),
              limb.chain.joint.col(1).dot(limb.chain.marker.col(4)), 1e-12);
}

TEST(Chain, ALineKeepsItsLengthsOnly) {
  auto limb = make_random_chain({.kind = SegmentKind::line});
  limb.chain.marker.row(0).setConstant(0.001);
  make_canonical(limb.chain);
  EXPECT_EQ(limb.chain.marker.topRows<2>().norm(), 0.0);
  EXPECT_NEAR(std::abs(limb.chain.marker(2, 0)), 0.1125, 1e-4);
}

// The same limb, described with its joint elsewhere: predictions stay when the joint's world position
// follows.
TEST(Chain, MovingAnOriginMovesEverythingElseTheOtherWay) {
  const auto limb = make_random_chain({.segments = 3, .frames = 1, .noise_sd_m = 0.0});
  const Vector3d change(0.01, -0.02, 0.03);
  Chain moved = limb.chain;
  move_joint(moved, 1, true, change);
  EXPECT_LT((moved.joint.col(1) - limb.chain.joint.col(1) - change).norm(), 1e-15);
  EXPECT_EQ(moved.marker, limb.chain.marker);
  moved = limb.chain;
  move_joint(moved, 0, true, change);  // joint 0 is the origin of segment 0
  ChainPose pose = limb.pose[0];
  pose.joint0 += pose.rotation[0] * change;
  for (int k = 0; k < 3; ++k)
    EXPECT_LT((moved.predict(pose, k) - limb.chain.predict(limb.pose[0], k)).norm(), 1e-12) << k;
  moved = limb.chain;
  move_joint(moved, 0, false, change);  // the origin of segment 1, which carries joint 1
  EXPECT_LT((moved.joint.col(1) - limb.chain.joint.col(1) + change).norm(), 1e-15);
  EXPECT_EQ(moved.marker.leftCols(3), limb.chain.marker.leftCols(3));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
