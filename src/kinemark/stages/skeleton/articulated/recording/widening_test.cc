// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/widening.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace kinemark::skeleton::articulated
