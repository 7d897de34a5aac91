// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/description.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinemark::skeleton {
namespace {

const Eigen::Vector3d kAround(0.3, 0.25, 0.1);  ///< rotations about more than one axis

data::SkeletonJoint ball(double range_rad, const Eigen::Vector3d& sd_m) {
  data::SkeletonJoint joint;
  joint.range_of_motion_rad = range_rad;
  joint.covariance_in_parent = sd_m.cwiseProduct(sd_m).asDiagonal();
  return joint;
}

TEST(DescribeJoint, ABallIsKnownAsFarAsItIs) {
  EXPECT_EQ(describe_joint(ball(1.0, {0.001, 0.0005, 0.002}), kAround),
            "57 deg of motion: centre known to 2.0 mm");
  EXPECT_EQ(describe_joint(ball(1.0, {0.001, 0.05, 0.002}), kAround),
            "57 deg of motion: centre known to 2.0 mm across one direction, to 50.0 mm along it");
  EXPECT_EQ(describe_joint(ball(0.5, {0.001, 0.05, 0.1}), kAround),
            "29 deg of motion: centre known to 1.0 mm in one direction only, to 100.0 mm in the others");
  EXPECT_EQ(describe_joint(ball(0.5, {0.1, 0.1, 0.1}), kAround),
            "29 deg of motion: centre not known (100.0 mm)");
}

TEST(DescribeJoint, AMotionThatIsTooSmallOrOneArcIsSaidWhereItMatters) {
  const auto wide = ball(1.0, {0.001, 0.05, 0.002}), narrow = ball(1.0, {0.001, 0.0005, 0.002});
  const Eigen::Vector3d arc(0.4, 0.09, 0.05), small(0.08, 0.07, 0.05);
  EXPECT_TRUE(describe_joint(wide, arc).ends_with(
      "to 50.0 mm along it: the motion was one arc only (SD 22.9 deg, 5.2 deg beside it)"));
  EXPECT_TRUE(describe_joint(wide, small).ends_with(": the motion was too small"));
  EXPECT_TRUE(describe_joint(wide, kAround).ends_with("along it")) << "the motion is not the reason";
  EXPECT_TRUE(describe_joint(wide, {0.4, 0.11, 0.05}).ends_with("along it"))
      << "more than a quarter is another arc";
  for (const auto& sd_rad : {arc, small})
    EXPECT_TRUE(describe_joint(narrow, sd_rad).ends_with("centre known to 2.0 mm")) << "nothing is lacking";
}

TEST(DescribeJoint, AHingeTellsAxisAndPosition) {
  data::SkeletonJoint joint = ball(0.21, {0.3, 0.03, 0.03});
  joint.kind = data::JointKind::hinge;
  joint.axis_in_parent = Eigen::Vector3d::UnitX();
  joint.axis_sd_rad = 0.035;
  EXPECT_EQ(describe_joint(joint, kAround),
            "12 deg of motion: axis direction known to 2.0 deg, its position not, position along it not");
  joint.covariance_in_parent = Eigen::Vector3d(0.09, 1e-6, 1e-6).asDiagonal();
  EXPECT_EQ(
      describe_joint(joint, kAround),
      "12 deg of motion: axis direction known to 2.0 deg, its position to 1.0 mm, position along it not");
  joint.axis_sd_rad = 0.5;
  EXPECT_NE(describe_joint(joint, kAround).find("axis direction not known"), std::string::npos);
}

TEST(DescribeJoint, RepeatingIsSaidWhereItIsNotBeingRight) {
  data::SkeletonJoint joint = ball(1.0, {0.001, 0.0005, 0.009});
  joint.repeatability_in_parent = 0.0008 * 0.0008 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(describe_joint(joint, kAround),
            "57 deg of motion: centre known to 9.0 mm; another part of the trial repeats it to 0.8 mm");
  joint.repeatability_in_parent = joint.covariance_in_parent;
  EXPECT_EQ(describe_joint(joint, kAround), "57 deg of motion: centre known to 9.0 mm")
      << "parts differ by all there is";
  joint.repeatability_in_parent.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(describe_joint(joint, kAround), "57 deg of motion: centre known to 9.0 mm");
}

TEST(DescribeJoint, PriorKnowledgeIsNotPassedOffAsData) {
  data::SkeletonJoint joint = ball(1.0, {0.001, 0.0005, 0.009});
  for (const double share : {0.51, 0.9}) {
    joint.prior_share = share;
    EXPECT_NE(describe_joint(joint, kAround).find("prior-dominated"), std::string::npos);
  }
  for (const double share : {0.0, 0.49, std::numeric_limits<double>::quiet_NaN()}) {
    joint.prior_share = share;
    EXPECT_EQ(describe_joint(joint, kAround), "57 deg of motion: centre known to 9.0 mm");
  }
}

bool says(const data::SkeletonJoint& joint, const char* words, const Eigen::Vector3d& sd_rad = kAround) {
  return describe_joint(joint, sd_rad).find(words) != std::string::npos;
}

TEST(DescribeJoint, ABallThatIsKnownHasNoOtherSentence) {
  const auto known = ball(1.0, {0.001, 0.0005, 0.002});
  EXPECT_FALSE(says(known, "axis direction known to"));
  EXPECT_FALSE(says(known, "axis direction not known"));
  EXPECT_FALSE(says(known, ", position along it not"));
  EXPECT_FALSE(says(known, ": the motion was too small", {0.08, 0.07, 0.05}));
  EXPECT_FALSE(says(known, ": the motion was one arc only (SD", {0.4, 0.09, 0.05}));
  EXPECT_FALSE(says(known, "mm across one direction, to"));
  EXPECT_FALSE(says(known, "mm in one direction only, to"));
  EXPECT_FALSE(says(known, "; another part of the trial repeats it to"));
  EXPECT_FALSE(says(known, "motion not seen as an angle"));
  EXPECT_FALSE(says(known, ": the joint hardly moves, neither centre nor axis can be known"));
  EXPECT_FALSE(says(known, "; prior-dominated: most of this is what is known of skin"));
}

TEST(DescribeJoint, WhatIsOpenIsSaidOfThatAlone) {
  const auto line = ball(1.0, {0.001, 0.05, 0.002}), plane = ball(0.5, {0.001, 0.05, 0.1});
  EXPECT_TRUE(says(line, "across one direction, to 50.0 mm along it"));
  EXPECT_FALSE(says(line, "in one direction only, to"));
  EXPECT_TRUE(says(plane, "in one direction only, to 100.0 mm in the others"));
  EXPECT_FALSE(says(plane, "across one direction, to"));
  EXPECT_FALSE(says(line, ": the motion was too small", {0.11, 0.07, 0.05}));
  EXPECT_TRUE(says(line, ": the motion was too small", {0.09, 0.07, 0.05}));
}

TEST(DescribeJoint, TheShareOfThePriorOfAHingeNamesWhatLeavesNoTrace) {
  data::SkeletonJoint hinge = ball(1.0, {0.09, 0.001, 0.001});
  hinge.kind = data::JointKind::hinge;
  hinge.axis_in_parent = Eigen::Vector3d::UnitX();
  hinge.axis_sd_rad = 0.035;
  hinge.prior_share = 0.8;
  EXPECT_TRUE(
      says(hinge, "; prior-dominated: most of this is what is known of skin, not what this recording shows"));
  EXPECT_TRUE(says(hinge, "(1 mm of sliding per rad moves the axis by 1 mm and leaves no trace)"));
  hinge.prior_share = 0.2;
  EXPECT_FALSE(says(hinge, "(1 mm of sliding per rad moves the axis by 1 mm and leaves no trace)"));
  data::SkeletonJoint joint = ball(1.0, {0.001, 0.0005, 0.009});
  joint.prior_share = 0.8;
  EXPECT_FALSE(says(joint, "(1 mm of sliding per rad moves the axis by 1 mm")) << "a ball is not a line";
}

TEST(DescribeJoint, AChildsCovarianceStandsInWhereTheParentsIsNotKnown) {
  data::SkeletonJoint joint = ball(1.0, {0.001, 0.001, 0.001});
  joint.covariance_in_parent.setConstant(std::numeric_limits<double>::quiet_NaN());
  joint.covariance_in_child = Eigen::Vector3d(1e-6, 4e-6, 9e-6).asDiagonal();
  EXPECT_EQ(describe_joint(joint, kAround), "57 deg of motion: centre known to 3.0 mm");
}

TEST(DescribeJoint, AStillJointAndAnUnknownOneSaySo) {
  EXPECT_EQ(describe_joint(ball(0.01, {0.3, 0.3, 0.3}), kAround),
            "1 deg of motion: the joint hardly moves, neither centre nor axis can be known");
  data::SkeletonJoint joint = ball(0.5, {1, 1, 1});
  joint.covariance_in_parent.setConstant(std::numeric_limits<double>::quiet_NaN());
  joint.covariance_in_child = joint.covariance_in_parent;
  joint.range_of_motion_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(describe_joint(joint, kAround), "motion not seen as an angle: centre not known");
}

}  // namespace
}  // namespace kinemark::skeleton
