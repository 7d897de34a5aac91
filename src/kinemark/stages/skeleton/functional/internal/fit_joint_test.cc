// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kinemark/stages/skeleton/functional/internal/assemble.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"

namespace kinemark::skeleton::internal {
namespace {

using data::JointKind;
using ::testing::HasSubstr;
using testing::JointSetup;
using testing::make_chain;
using ::testing::Not;
using testing::Rotations;
using testing::TestChain;

/// Largest distance of the fit's centre, carried into world by one segment's poses, from the truth, m.
double worst_error(const JointSetup& s, const JointFit& fit, bool in_parent) {
  const SegmentPoses& poses = in_parent ? s.parent : s.child;
  const Eigen::Vector3d p = in_parent ? fit.centre.head<3>() : fit.centre.tail<3>();
  double worst = 0.0;
  for (std::int64_t f = 0; f < s.chain.markers.frames(); ++f)
    if (poses.known[static_cast<std::size_t>(f)])
      worst = std::max(worst, (poses.to_world(f, p) - s.chain.centres[0].col(f)).norm());
  return worst;
}

TEST(FitJoint, EveryMethodIsExactOnExactData) {
  const JointSetup s({.frames = 80, .per_segment = 4});
  for (const auto method :
       {FunctionalMethod::score, FunctionalMethod::gamage, FunctionalMethod::gamage_plain}) {
    std::string why;
    const auto fit = fit_joint(s.samples, s.task, {.method = method}, why);
    ASSERT_TRUE(fit.has_value()) << why;
    EXPECT_TRUE(why.empty()) << why;  // nothing to add where all is as it was asked for
    EXPECT_EQ(fit->kind, JointKind::ball);
    EXPECT_TRUE(fit->in_parent && fit->in_child);
    EXPECT_LT(worst_error(s, *fit, true), 1e-4) << to_string(method);
    EXPECT_LT(worst_error(s, *fit, false), 1e-4) << to_string(method);
    EXPECT_GT(fit->frames, 0);
  }
}

TEST(FitJoint, AHingeIsFoundOrForced) {
  const JointSetup hinge(
      {.frames = 120, .per_segment = 4, .rotations = Rotations::hinge, .noise_sd_m = 0.0005});
  const JointSetup ball({.frames = 120, .per_segment = 4, .noise_sd_m = 0.0005});
  std::string why;
  EXPECT_EQ(fit_joint(hinge.samples, hinge.task, {}, why)->kind, JointKind::hinge);
  EXPECT_EQ(fit_joint(ball.samples, ball.task, {}, why)->kind, JointKind::ball);
  EXPECT_EQ(fit_joint(hinge.samples, hinge.task, {.kind = data::JointChoice::ball}, why)->kind,
            JointKind::ball);
  EXPECT_EQ(fit_joint(ball.samples, ball.task, {.kind = data::JointChoice::hinge}, why)->kind,
            JointKind::hinge);
  for (const auto method : {FunctionalMethod::sara, FunctionalMethod::cylinder}) {
    const auto fit = fit_joint(hinge.samples, hinge.task, {.method = method}, why);
    ASSERT_TRUE(fit.has_value());
    EXPECT_EQ(fit->kind, JointKind::hinge) << "by definition";
    EXPECT_NEAR(fit->axis_in_parent.norm(), 1.0, 1e-9);
    EXPECT_GT(fit->axis_sd_rad, 0.0);
    // The axis is the same direction in world, seen from either segment.
    const Eigen::Vector3d a = hinge.parent.world_from_segment[7] * fit->axis_in_parent,
                          b = hinge.child.world_from_segment[7] * fit->axis_in_child;
    EXPECT_GT(std::abs(a.dot(b)), std::cos(0.05)) << to_string(method);
  }
}

TEST(FitJoint, OneSideAloneIsThatSideOfBoth) {
  const JointSetup s({.frames = 100, .per_segment = 4, .noise_sd_m = 0.001});
  for (const auto method : {FunctionalMethod::score, FunctionalMethod::gamage}) {
    std::string why;
    const auto both = fit_joint(s.samples, s.task, {.method = method}, why);
    const auto parent = fit_joint(s.samples, s.task, {.method = method, .sides = Sides::parent}, why);
    const auto child = fit_joint(s.samples, s.task, {.method = method, .sides = Sides::child}, why);
    ASSERT_TRUE(both && parent && child);
    EXPECT_TRUE(parent->in_parent && !parent->in_child);
    EXPECT_TRUE(!child->in_parent && child->in_child);
    EXPECT_LT((parent->centre.head<3>() - both->centre.head<3>()).norm(), 1e-12);
    EXPECT_LT((child->centre.tail<3>() - both->centre.tail<3>()).norm(), 1e-12);
    EXPECT_TRUE(why.empty()) << why;
  }
}

/// The second segment shows no more than two markers in any frame.
TestChain without_child_poses() {
  TestChain chain = make_chain({.frames = 100, .noise_sd_m = 0.0005});
  for (std::int64_t f = 0; f < 100; ++f) chain.markers.set_missing(f, 3);
  return chain;
}

TEST(FitJoint, ASegmentWithoutPosesLeavesTheOtherSide) {
  const JointSetup s(without_child_poses());
  ASSERT_EQ(s.child.known_frames, 0);
  std::string why;
  const auto fit = fit_joint(s.samples, s.task, {}, why);
  ASSERT_TRUE(fit.has_value()) << why;
  EXPECT_TRUE(fit->in_parent && !fit->in_child);
  EXPECT_THAT(why, HasSubstr("'s1' has no pose, so the joint was placed from 's0' alone"));
  EXPECT_THAT(why, HasSubstr("(Gamage-Lasenby)")) << "what was used instead of SCoRE";
  EXPECT_LT(worst_error(s, *fit, true), 0.003);
}

TEST(FitJoint, SaysWhenNothingCanBePlaced) {
  const JointSetup s(without_child_poses());
  std::string why;
  EXPECT_FALSE(
      fit_joint(s.samples, s.task, {.method = FunctionalMethod::gamage, .sides = Sides::child}, why));
  EXPECT_THAT(why, HasSubstr("no frame shows three markers of 's1' that are not on a line; without a pose"));
  EXPECT_THAT(why, Not(HasSubstr("the markers' paths in the segments show no centre")));
}

TEST(FitJoint, OneFrameHasPosesAndNoCentre) {
  const JointSetup s({.frames = 1, .per_segment = 4});
  ASSERT_EQ(s.parent.known_frames + s.child.known_frames, 2);
  std::string why;
  EXPECT_FALSE(fit_joint(s.samples, s.task, {.method = FunctionalMethod::gamage}, why));
  EXPECT_EQ(why, "the markers' paths in the segments show no centre");
  EXPECT_THAT(why, Not(HasSubstr("that are not on a line; without a pose of a segment")));
}

TEST(FitJoint, SegmentsThatAreNeverSeenTogetherAreFittedOneByOne) {
  TestChain chain = make_chain({.frames = 200, .per_segment = 4});
  // Every frame shows three markers of one segment and two of the other: one pose at a time.
  for (std::int64_t f = 0; f < 200; ++f) {
    const std::int64_t first = f % 2 == 0 ? 0 : 4;
    chain.markers.set_missing(f, first);
    chain.markers.set_missing(f, first + 1);
  }
  const JointSetup s(std::move(chain));
  ASSERT_TRUE(s.task.motion.frames.empty());
  std::string why;
  const auto fit = fit_joint(s.samples, s.task, {.kind = data::JointChoice::ball}, why);
  ASSERT_TRUE(fit.has_value()) << why;
  EXPECT_EQ(why,
            "too few frames show both segments' poses at once; each side was fitted alone (Gamage-Lasenby)");
  EXPECT_THAT(why, Not(HasSubstr("so the joint was placed from '")));
  std::string of_one;
  EXPECT_TRUE(
      fit_joint(s.samples, s.task, {.sides = Sides::parent, .kind = data::JointChoice::ball}, of_one));
  EXPECT_THAT(of_one, HasSubstr("one side was fitted alone"));
  EXPECT_LT(worst_error(s, *fit, true), 1e-4);
  EXPECT_LT(worst_error(s, *fit, false), 1e-4);
}

}  // namespace
}  // namespace kinemark::skeleton::internal
