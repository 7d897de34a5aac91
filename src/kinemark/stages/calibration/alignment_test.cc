// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinemark/core/units.h"
#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace ts = testing_support;

/// The ideal rig with its second camera rotated (rad, about its own right, down, forward) and shifted (m, its
/// axes).
data::Rig moved_b(const Vector3d& rotation, const Vector3d& shift) {
  auto rig = ts::ideal_rig();
  auto& camera = rig.cameras[1];
  const Eigen::Matrix3d world_from_cam = camera.cam_from_world.rotation.transpose();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(data::ParameterLayout(camera).count);
  step.segment<3>(data::ParameterLayout::rotation) = rotation;
  step.segment<3>(data::ParameterLayout::centre) = world_from_cam * shift;
  camera = camera::moved(camera, step);
  return rig;
}

TEST(Alignment, PerfectRigsNeedNothing) {
  const auto a = compare_alignment(ts::ideal_rig(), ts::ideal_rig()).value();
  EXPECT_TRUE(a.aligned);
  EXPECT_EQ(a.next, "nothing: all cameras are within tolerance");
  EXPECT_LT(a.cameras[1].shift_m.norm(), 1e-9);
}

TEST(Alignment, TheWorldDoesNotMatter) {
  auto rig = ts::ideal_rig();
  const math::SE3 motion{Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
                         {1.0, -2.0, 0.5}};
  for (auto& camera : rig.cameras) camera.cam_from_world = camera.cam_from_world * motion;
  EXPECT_TRUE(compare_alignment(ts::ideal_rig(), rig)->aligned);
}

TEST(Alignment, SaysWhichWayToTurnAndMove) {
  // A roll has nothing to trade with: both cameras share it by half.
  const auto roll = compare_alignment(ts::ideal_rig(), moved_b({0, 0, 0.02}, Vector3d::Zero())).value();
  EXPECT_FALSE(roll.aligned);
  EXPECT_NEAR(roll.cameras[1].rotation_deg.z() - roll.cameras[0].rotation_deg.z(), 0.02 * kDegPerRad, 0.5);
  const auto forward = compare_alignment(ts::ideal_rig(), moved_b(Vector3d::Zero(), {0, 0, 0.02})).value();
  EXPECT_GT(forward.cameras[1].shift_m.z(), 5e-3);
  const auto back = compare_alignment(ts::ideal_rig(), moved_b(Vector3d::Zero(), {0, 0, -0.02})).value();
  EXPECT_NEAR(back.cameras[1].shift_m.z(), -forward.cameras[1].shift_m.z(), 1e-3);
  EXPECT_THAT(forward.next, ::testing::AnyOf(HasSubstr("mm"), HasSubstr("deg")));
  EXPECT_THAT(forward.next, Not(HasSubstr("nothing: all cameras are within tolerance")));
}

/// Three times the first camera, which hold the world fast, and the second.
data::Rig held(data::Rig rig) {
  rig.cameras = {rig.cameras[0], rig.cameras[0], rig.cameras[0], rig.cameras[1]};
  return rig;
}

/// A point of the wanted rig's last camera, as the one found sees it.
Vector3d seen_by(const data::Rig& found, const Vector3d& x_in_wanted) {
  return found.cameras[3].cam_from_world *
         (held(ts::ideal_rig()).cameras[3].cam_from_world.inverse() * x_in_wanted);
}

TEST(Alignment, WhatIsSeenOnOneSideIsPannedToIt) {
  for (const double rad : {0.02, -0.02}) {
    const auto found = held(moved_b({0.0, rad, 0.0}, Vector3d::Zero()));
    const auto a = compare_alignment(held(ts::ideal_rig()), found, {.shift_tolerance_m = 1.0}).value();
    const bool right = seen_by(found, {0.0, 0.0, 3.0}).x() > 0.0;
    EXPECT_THAT(a.next, AllOf(HasSubstr("camera 'B': "),
                              HasSubstr(right ? "pan it to the right by" : "pan it to the left by")));
    EXPECT_THAT(a.next, Not(HasSubstr(right ? "pan it to the left" : "pan it to the right")));
    EXPECT_THAT(a.next, Not(HasSubstr("camera 'B': move it ")));
  }
}

TEST(Alignment, ARollIsUndone) {
  for (const double rad : {0.02, -0.02}) {
    const auto found = held(moved_b({0.0, 0.0, rad}, Vector3d::Zero()));
    const auto a = compare_alignment(held(ts::ideal_rig()), found, {.shift_tolerance_m = 1.0}).value();
    // What is to the right appears lower where the image is turned clockwise: the camera turns after it.
    const bool clockwise = seen_by(found, {0.5, 0.0, 3.0}).y() > 0.0;
    EXPECT_THAT(a.next, HasSubstr(clockwise ? "roll it clockwise by" : "roll it counter-clockwise by"));
    EXPECT_THAT(a.next, Not(HasSubstr(clockwise ? "roll it counter-clockwise" : "roll it clockwise")));
  }
}

TEST(Alignment, AShiftIsMovedBack) {
  const auto next = [](const Vector3d& shift) {
    return compare_alignment(held(ts::ideal_rig()), held(moved_b(Vector3d::Zero(), shift)),
                             {.rotation_tolerance_deg = 90.0})
        ->next;
  };
  EXPECT_THAT(next({0.0, 0.0, 0.05}), AllOf(HasSubstr("camera 'B': move it "), HasSubstr(" mm back")));
  EXPECT_THAT(next({0.0, 0.0, -0.05}), AllOf(HasSubstr("camera 'B': move it "), HasSubstr(" mm forward")));
}

TEST(Alignment, FindsItFromTheTree) {
  const auto truth = moved_b({0.01, -0.008, 0.012}, {0.015, -0.01, 0.02});
  const auto real = compare_alignment(ts::ideal_rig(), truth).value();
  const auto found = align_by_tree(ts::ideal_rig(), tree_observations(truth, 30, 3));
  ASSERT_TRUE(found) << found.error().message;
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_LT((found->cameras[c].rotation_deg - real.cameras[c].rotation_deg).norm(), 0.25);
    EXPECT_LT((found->cameras[c].shift_m - real.cameras[c].shift_m).norm(), 12e-3);
  }
  EXPECT_GT(found->cameras[1].shift_sd_m.norm(), 0.0);
  EXPECT_FALSE(found->aligned);
}

TEST(Alignment, RefusesRigsThatDiffer) {
  auto one = ts::ideal_rig();
  one.cameras.pop_back();
  EXPECT_THAT(compare_alignment(ts::ideal_rig(), one).error().message,
              HasSubstr("2 cameras are wanted and 1"));
  EXPECT_FALSE(AlignmentOptions{.shift_tolerance_m = 0.0}.check());
}

}  // namespace
}  // namespace kinemark::calibration
