// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/skin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;

constexpr double kSize_m = 0.1;
const Matrix3d kCovariance = Vector3d(1e-6, 2e-6, 3e-6).asDiagonal();

/// One joint in four frames, the third undetermined; its axis is x in both segments.
data::Skeleton small_skeleton() {
  data::Skeleton out;
  out.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 4};
  out.joints.resize(1);
  out.joints[0].axis_in_parent = out.joints[0].axis_in_child = Vector3d::UnitX();
  out.joints[0].covariance_in_parent = out.joints[0].covariance_in_child = kCovariance;
  out.allocate_centres();
  for (std::int64_t f = 0; f < 4; ++f) {
    if (f == 2) continue;
    out.state[out.index(f, 0)] = CentreState::determined;
    store_symmetric(out.covariance.data() + 6 * out.index(f, 0), kCovariance);
  }
  return out;
}

/// Poses of frames 0 and 3: the segment's x axis is the lab's x, then the lab's y.
std::vector<SampledPose> two_poses() {
  Matrix3d quarter;
  quarter << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  return {
      {.frame = 0,
       .pose = {.joint0 = Vector3d::Zero(), .rotation = {Matrix3d::Identity()}},
       .cost = 0.0,
       .known = {1}},
      {.frame = 3, .pose = {.joint0 = Vector3d::Zero(), .rotation = {quarter}}, .cost = 0.0, .known = {1}}};
}

TEST(WidenAlongAxis, TheAxisGetsTheSizeAndTheRestStays) {
  data::Skeleton skeleton = small_skeleton();
  widen_along_axis(two_poses(), 0, Vector3d::UnitX(), 0, kSize_m, skeleton);
  Matrix3d along_x = kCovariance, along_y = kCovariance;
  along_x(0, 0) = kSize_m * kSize_m;
  along_y(1, 1) = kSize_m * kSize_m;
  EXPECT_LT((skeleton.centre_covariance(0, 0) - along_x).norm(), 1e-15);
  EXPECT_LT((skeleton.centre_covariance(1, 0) - along_x).norm(), 1e-15) << "the last pose before it";
  EXPECT_LT((skeleton.centre_covariance(3, 0) - along_y).norm(), 1e-15);
  EXPECT_LT((skeleton.joints[0].covariance_in_parent - along_x).norm(), 1e-15);
  EXPECT_LT((skeleton.joints[0].covariance_in_child - along_x).norm(), 1e-15);
}

TEST(WidenAlongAxis, DoesNothingTwice) {
  data::Skeleton once = small_skeleton();
  widen_along_axis(two_poses(), 0, Vector3d::UnitX(), 0, kSize_m, once);
  data::Skeleton twice = once;
  widen_along_axis(two_poses(), 0, Vector3d::UnitX(), 0, kSize_m, twice);
  for (const std::int64_t f : {0, 1, 3})
    EXPECT_LT((twice.centre_covariance(f, 0) - once.centre_covariance(f, 0)).norm(), 1e-12) << f;
  widen_along_axis(two_poses(), 0, Vector3d::UnitX(), 0, 0.5 * kSize_m, twice);
  EXPECT_LT((twice.centre_covariance(0, 0) - once.centre_covariance(0, 0)).norm(), 1e-12) << "never narrower";
}

TEST(WidenAlongAxis, FramesWithoutACentreOrAPoseStay) {
  data::Skeleton skeleton = small_skeleton();
  const auto at_2 = 6 * skeleton.index(2, 0);
  const bool missing = std::isnan(skeleton.covariance[at_2]);
  widen_along_axis(two_poses(), 0, Vector3d::UnitX(), 0, kSize_m, skeleton);
  EXPECT_EQ(std::isnan(skeleton.covariance[at_2]), missing);
  data::Skeleton none = small_skeleton();
  widen_along_axis({}, 0, Vector3d::UnitX(), 0, kSize_m, none);
  EXPECT_EQ(none.centre_covariance(0, 0), kCovariance);
  EXPECT_GT(none.joints[0].covariance_in_parent(0, 0), 0.5 * kSize_m * kSize_m)
      << "in its segments all the same";
}

TEST(WidenAllAround, EveryDirectionGetsTheSize) {
  data::Skeleton skeleton = small_skeleton();
  widen_all_around(0, kSize_m, skeleton);
  const Matrix3d expected = kCovariance + kSize_m * kSize_m * Matrix3d::Identity();
  for (const std::int64_t f : {0, 1, 3})
    EXPECT_LT((skeleton.centre_covariance(f, 0) - expected).norm(), 1e-15) << f;
  EXPECT_LT((skeleton.joints[0].covariance_in_parent - expected).norm(), 1e-15);
  EXPECT_LT((skeleton.joints[0].covariance_in_child - expected).norm(), 1e-15);
  EXPECT_EQ(skeleton.state[skeleton.index(2, 0)], CentreState::undetermined);
}

constexpr double kVariance_m2 = 1e-8;  ///< of the joint before skin is asked for

/// A joint that was found to 0.1 mm a coordinate, before and after skin was asked for.
struct Asked {
  testing::TestChain chain;
  data::Skeleton before, after;

  explicit Asked(const testing::SwingSetup& swings, bool lines = false)
      : chain(testing::make_swings(swings)) {
    before = find_joints(chain.markers, chain.layout,
                         {.kind = swings.hinge ? data::JointChoice::hinge : data::JointChoice::ball})
                 .value();
    auto& joint = before.joints[0];
    joint.covariance_in_parent = joint.covariance_in_child = kVariance_m2 * Eigen::Matrix3d::Identity();
    joint.repeatability_in_parent = joint.repeatability_in_child = joint.covariance_in_parent;
    joint.skin = {};
    for (std::size_t i = 0; i < before.covariance.size(); ++i)
      before.covariance[i] = i % 6 == 0 || i % 6 == 3 || i % 6 == 5 ? kVariance_m2 : 0.0;
    if (lines) before.segments[1].kind = data::SegmentKind::line;
    after = before;
    account_for_skin(chain.markers, after);
  }
  [[nodiscard]] const data::SkeletonJoint& joint() const { return after.joints[0]; }
  [[nodiscard]] Eigen::Vector3d moved() const {
    return joint().centre_in_child - before.joints[0].centre_in_child;
  }
  [[nodiscard]] SkinSlide slide() const {
    const Samples samples{chain.markers, {}};
    const auto poses = [&](std::size_t s) {
      const auto& segment = before.segments[s];
      return pose_known_shape(samples, segment.name, segment.markers, segment.x_in_segment);
    };
    const auto parent = poses(0), child = poses(1);
    const auto motion = measure_motion(parent, child);
    return measure_skin_slide(samples, parent, child, motion,
                              fit_score(samples, parent, child, motion, before.joints[0].kind));
  }
};

TEST(AccountForSkin, RigidMarkersLeaveTheJointWhereItIs) {
  for (const bool hinge : {false, true})
    for (const double noise_sd_m : {0.0005, 0.002}) {
      const Asked asked({.hinge = hinge, .noise_sd_m = noise_sd_m});
      EXPECT_NE(asked.joint().skin.verdict, data::SkinVerdict::follows);
      EXPECT_NE(asked.joint().skin.verdict, data::SkinVerdict::untested);
      EXPECT_EQ(asked.moved().norm(), 0.0);
      EXPECT_EQ(asked.after.centre_in_world, asked.before.centre_in_world);
      // Least squares' own error by noise is not the chain's: it counts by the probability of a slide.
      const auto slide = asked.slide();
      const double whole =
          slide.shift.tail<3>().squaredNorm() + slide.covariance.bottomRightCorner<3, 3>().trace();
      EXPECT_LT(asked.joint().covariance_in_child.trace(),
                3.0 * kVariance_m2 * slide.frames_alike + 0.8 * whole)
          << hinge << " " << noise_sd_m;
    }
}

TEST(AccountForSkin, WhereSkinIsSeenTheJointMovesHalfOfTheWay) {
  const Asked asked({.own_slide_m = 0.008, .common_slide_m = 0.004});
  ASSERT_EQ(asked.joint().skin.verdict, data::SkinVerdict::follows);
  const auto slide = asked.slide();
  EXPECT_LT((asked.moved() - 0.5 * slide.shift.tail<3>()).norm(), 1e-9);
  EXPECT_GT(asked.moved().norm(), 0.0005);
  // What was moved may be missing in another part of the trial.
  const Eigen::Vector3d along = asked.moved().normalized();
  EXPECT_GE(along.dot(asked.joint().repeatability_in_child * along), asked.moved().squaredNorm());
  EXPECT_GT(asked.joint().covariance_in_child.trace(), 0.9 * slide.shift.tail<3>().squaredNorm() / 4.0);
  const std::size_t i = asked.after.index(7, 0);
  EXPECT_NE(asked.after.centre_in_world[3 * i], asked.before.centre_in_world[3 * i]);
  EXPECT_GT(asked.after.covariance[6 * i], kVariance_m2);
  EXPECT_FALSE(asked.joint().description.empty());
}

TEST(AccountForSkin, SegmentsWithoutAPoseAreLeftAlone) {
  const Asked asked({.own_slide_m = 0.008}, true);
  EXPECT_EQ(asked.joint().skin.verdict, data::SkinVerdict::untested);
  EXPECT_EQ(asked.moved().norm(), 0.0);
  EXPECT_EQ(asked.joint().covariance_in_child, asked.before.joints[0].covariance_in_child);
  EXPECT_EQ(asked.after.covariance, asked.before.covariance);
}

}  // namespace

}  // namespace kinemark::skeleton::articulated
