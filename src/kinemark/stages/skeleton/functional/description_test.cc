// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/description.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinemark::skeleton {
namespace {

data::SkeletonJoint ball(double range_rad, const Eigen::Vector3d& sd_m) {
  data::SkeletonJoint joint;
  joint.range_of_motion_rad = range_rad;
  joint.covariance_in_parent = sd_m.cwiseProduct(sd_m).asDiagonal();
  return joint;
}

TEST(DescribeJoint, ABallIsKnownAsFarAsItIs) {
  EXPECT_EQ(describe_joint(ball(1.0, {0.001, 0.0005, 0.002})), "57 deg of motion: centre known to 2.0 mm");
  EXPECT_EQ(describe_joint(ball(1.0, {0.001, 0.05, 0.002})),
            "57 deg of motion: centre known to 2.0 mm across one direction, to 50.0 mm along it");
  EXPECT_EQ(describe_joint(ball(0.5, {0.001, 0.05, 0.1})),
            "29 deg of motion: centre known to 1.0 mm in one direction only, to 100.0 mm in the others");
  EXPECT_EQ(describe_joint(ball(0.5, {0.1, 0.1, 0.1})), "29 deg of motion: centre not known (100.0 mm)");
}

TEST(DescribeJoint, AHingeTellsAxisAndPosition) {
  data::SkeletonJoint joint = ball(0.21, {0.3, 0.03, 0.03});
  joint.kind = data::JointKind::hinge;
  joint.axis_in_parent = Eigen::Vector3d::UnitX();
  joint.axis_sd_rad = 0.035;
  EXPECT_EQ(describe_joint(joint),
            "12 deg of motion: axis direction known to 2.0 deg, its position not, position along it not");
  joint.covariance_in_parent = Eigen::Vector3d(0.09, 1e-6, 1e-6).asDiagonal();
  EXPECT_EQ(
      describe_joint(joint),
      "12 deg of motion: axis direction known to 2.0 deg, its position to 1.0 mm, position along it not");
  joint.axis_sd_rad = 0.5;
  EXPECT_NE(describe_joint(joint).find("axis direction not known"), std::string::npos);
}

TEST(DescribeJoint, AStillJointAndAnUnknownOneSaySo) {
  EXPECT_EQ(describe_joint(ball(0.01, {0.3, 0.3, 0.3})),
            "1 deg of motion: the joint hardly moves, neither centre nor axis can be known");
  data::SkeletonJoint joint = ball(0.5, {1, 1, 1});
  joint.covariance_in_parent.setConstant(std::numeric_limits<double>::quiet_NaN());
  joint.covariance_in_child = joint.covariance_in_parent;
  joint.range_of_motion_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(describe_joint(joint), "motion not seen as an angle: centre not known");
}

}  // namespace
}  // namespace kinemark::skeleton
