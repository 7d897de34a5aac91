// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "kinemark/stages/skeleton/functional/internal/assemble.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"

namespace kinemark::skeleton::internal {
namespace {

using data::CentreState;
using testing::centre_error;
using testing::JointSetup;
using testing::make_chain;
using testing::TestChain;

JointFit fit_of(const JointSetup& s, const FunctionalOptions& options = {}) {
  std::string why;
  return fit_joint(s.samples, s.task, options, why).value();
}

TEST(PlaceJoint, CentresAreExactOnExactData) {
  const JointSetup s({.frames = 60, .per_segment = 4, .missing = 0.1});
  data::Skeleton skeleton = s.empty_skeleton();
  place_joint(s.samples, s.task, fit_of(s), 0, skeleton);
  const auto error = centre_error(skeleton, s.chain, 0);
  EXPECT_LT(error.rms_m, 1e-5);
  for (std::int64_t f = 0; f < 60; ++f) {
    const auto k = static_cast<std::size_t>(f);
    const bool known = s.parent.known[k] != 0 || s.child.known[k] != 0;
    EXPECT_EQ(skeleton.state[skeleton.index(f, 0)],
              known ? CentreState::determined : CentreState::undetermined)
        << f;
  }
}

// Each side errs by its own noise: their mean errs less than one alone.
TEST(PlaceJoint, TwoSidesAreBetterThanOne) {
  const JointSetup s({.frames = 300, .per_segment = 4, .noise_sd_m = 0.002});
  const auto rms = [&](Sides sides) {
    data::Skeleton skeleton = s.empty_skeleton();
    place_joint(s.samples, s.task, fit_of(s, {.sides = sides}), 0, skeleton);
    return centre_error(skeleton, s.chain, 0).rms_m;
  };
  const double both = rms(Sides::both);
  EXPECT_LT(both, rms(Sides::parent));
  EXPECT_LT(both, rms(Sides::child));
}

TEST(PlaceJoint, CovarianceCoversTheError) {
  const JointSetup s({.frames = 400, .per_segment = 4, .noise_sd_m = 0.001});
  data::Skeleton skeleton = s.empty_skeleton();
  place_joint(s.samples, s.task, fit_of(s), 0, skeleton);
  double z2 = 0.0;
  for (std::int64_t f = 0; f < 400; ++f) {
    const Eigen::Vector3d error = skeleton.centre(f, 0) - s.chain.centres[0].col(f);
    z2 += error.squaredNorm() / skeleton.centre_covariance(f, 0).trace() / 400.0;
  }
  EXPECT_GT(z2, 0.5);
  EXPECT_LT(z2, 1.7);
}

TEST(PlaceJoint, AFrameWithoutPosesHasNoCentre) {
  TestChain chain = make_chain({.frames = 40, .per_segment = 4});
  for (std::int64_t m = 0; m < 8; ++m) chain.markers.set_missing(5, m);
  for (std::int64_t m = 0; m < 4; ++m) chain.markers.set_missing(6, m);  // the parent is gone
  const JointSetup s(std::move(chain));
  data::Skeleton skeleton = s.empty_skeleton();
  place_joint(s.samples, s.task, fit_of(s), 0, skeleton);
  EXPECT_EQ(skeleton.state[skeleton.index(5, 0)], CentreState::undetermined);
  EXPECT_TRUE(skeleton.centre(5, 0).hasNaN());
  EXPECT_EQ(skeleton.state[skeleton.index(6, 0)], CentreState::determined);
  EXPECT_LT((skeleton.centre(6, 0) - s.chain.centres[0].col(6)).norm(), 1e-5);
}

TEST(PlaceJoint, ConstantDistancesKeepTheirStates) {
  const JointSetup s({.frames = 3, .per_segment = 4});
  ConstantDistanceFit fit;
  fit.state = {CentreState::determined, CentreState::undetermined, CentreState::ambiguous};
  fit.centre_in_world.assign(3, Eigen::Vector3d(1.0, 2.0, 3.0));
  fit.covariance.assign(3, Eigen::Matrix3d(Eigen::Vector3d(1e-6, 2e-6, 3e-6).asDiagonal()));
  data::Skeleton skeleton = s.empty_skeleton();
  place_joint(fit, 0, skeleton);
  EXPECT_EQ(skeleton.state[0], CentreState::determined);
  EXPECT_EQ(skeleton.state[1], CentreState::undetermined);
  EXPECT_EQ(skeleton.state[2], CentreState::ambiguous);
  EXPECT_EQ(skeleton.centre(2, 0), fit.centre_in_world[2]);
  EXPECT_EQ(skeleton.centre_covariance(0, 0), fit.covariance[0]);
  EXPECT_TRUE(skeleton.centre(1, 0).hasNaN());
}

TEST(Describe, OneSideLeavesTheOtherUnknown) {
  JointFit fit;
  fit.method = "SCoRE";
  fit.in_parent = true;
  fit.centre.head<3>() = Eigen::Vector3d(0.0, 0.0, 0.15);
  fit.centre.tail<3>() = Eigen::Vector3d(9.0, 9.0, 9.0);
  fit.covariance = 1e-6 * Matrix6::Identity();
  RelativeMotion motion;
  motion.range_rad = 0.5;
  data::SkeletonJoint joint;
  describe(fit, motion, joint);
  EXPECT_EQ(joint.centre_in_parent, Eigen::Vector3d(0.0, 0.0, 0.15));
  EXPECT_NEAR(joint.covariance_in_parent(1, 1), 1e-6, 1e-18);
  EXPECT_TRUE(joint.covariance_in_child.hasNaN());
  EXPECT_NE(joint.centre_in_child, Eigen::Vector3d(9.0, 9.0, 9.0))
      << "not taken from a side that is not known";
  EXPECT_TRUE(std::isnan(joint.range_of_motion_rad)) << "no two frames show it";
  motion.frames = {3, 8};
  describe(fit, motion, joint);
  EXPECT_EQ(joint.range_of_motion_rad, 0.5);
  EXPECT_FALSE(joint.description.empty());
}

/// Joints 0 and 1 on segment 1, a length apart along z; joint 2 elsewhere.
data::Skeleton two_joints_of_a_segment(double length_m) {
  data::Skeleton out;
  out.segments.resize(4);
  out.joints.resize(3);
  const Eigen::Matrix3d C = Eigen::Vector3d(1e-2, 1e-2, 2e-6).asDiagonal();
  for (int j = 0; j < 3; ++j) {
    auto& joint = out.joints[static_cast<std::size_t>(j)];
    joint.name = "j" + std::to_string(j);
    joint.parent_segment = j;
    joint.child_segment = j + 1;
    joint.covariance_in_parent = joint.covariance_in_child = C;
    joint.centre_in_parent = Eigen::Vector3d(0.0, 0.0, length_m);
    joint.centre_in_child.setZero();
  }
  return out;
}

TEST(AddLengths, AreBetweenJointsOfOneSegmentWithTheirSd) {
  data::Skeleton skeleton = two_joints_of_a_segment(0.15);
  add_lengths(skeleton);
  ASSERT_EQ(skeleton.lengths.size(), 2U) << "not between joints 0 and 2";
  EXPECT_EQ(skeleton.lengths[0].name, "j0-j1");
  EXPECT_NEAR(skeleton.lengths[0].length_m, 0.15, 1e-15);
  EXPECT_NEAR(skeleton.lengths[0].sd_m, 0.002, 1e-12) << "along the segment alone";
  EXPECT_EQ(skeleton.lengths[1].joint_a, 1);
  EXPECT_EQ(skeleton.lengths[1].joint_b, 2);
}

TEST(AddLengths, WhatIsNotKnownHasNone) {
  data::Skeleton skeleton = two_joints_of_a_segment(0.15);
  skeleton.joints[1].covariance_in_parent.setConstant(std::nan(""));
  add_lengths(skeleton);
  ASSERT_EQ(skeleton.lengths.size(), 1U);
  EXPECT_EQ(skeleton.lengths[0].name, "j1-j2");
  data::Skeleton same = two_joints_of_a_segment(0.0);
  add_lengths(same);
  EXPECT_TRUE(same.lengths.empty()) << "no direction, no SD";
}

}  // namespace
}  // namespace kinemark::skeleton::internal
