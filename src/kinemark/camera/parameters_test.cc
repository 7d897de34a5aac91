// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kinemark/camera/projection.h"
#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

using data::CameraKind;
using data::DetectorKind;
using data::ParameterLayout;

TEST(Parameters, NamesAreUniqueAndAsManyAsTheLayoutSays) {
  for (const auto kind : {DetectorKind::tetra_lateral, DetectorKind::generic}) {
    const auto c = imperfect_camera(CameraKind::lateral_effect, kind, 1);
    const ParameterLayout layout(c);
    const auto names = parameter_names(c);
    EXPECT_EQ(names.size(), static_cast<std::size_t>(layout.count));
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    EXPECT_EQ(names[ParameterLayout::focal], "focal");
    EXPECT_EQ(names[ParameterLayout::warp_x + 1], "warp_x_1_1");
    EXPECT_EQ(names[static_cast<std::size_t>(layout.warp_y)], "warp_y_2_0");
    EXPECT_EQ(names[static_cast<std::size_t>(layout.gain)], "gain_0");
    EXPECT_EQ(names.back(), "offset_3");
  }
  EXPECT_EQ(parameter_names(imperfect_camera(CameraKind::pinhole, DetectorKind::tetra_lateral, 1)).size(),
            15U);
}

TEST(Moved, EachParameterMovesWhatItsNameSays) {
  const auto c = imperfect_camera(CameraKind::lateral_effect, DetectorKind::tetra_lateral, 1);
  const ParameterLayout layout(c);
  const auto step = [&](int i) { return moved(c, 0.01 * Eigen::VectorXd::Unit(layout.count, i)); };
  EXPECT_NEAR(step(ParameterLayout::focal).focal, c.focal + 0.01, 1e-15);
  EXPECT_NEAR(step(ParameterLayout::distortion + 3).distortion.p1, c.distortion.p1 + 0.01, 1e-15);
  EXPECT_NEAR(step(layout.warp_y + 2).detector.warp_y[2], c.detector.warp_y[2] + 0.01, 1e-15);
  EXPECT_NEAR(step(layout.crosstalk).detector.crosstalk(0, 1), c.detector.crosstalk(0, 1) + 0.01, 1e-15);
  EXPECT_NEAR(step(layout.offset + 3).detector.offset_counts[3], c.detector.offset_counts[3] + 0.01, 1e-15);
  const auto shifted = step(ParameterLayout::centre + 1);
  EXPECT_LT((shifted.centre_in_world() - c.centre_in_world() - Eigen::Vector3d(0, 0.01, 0)).norm(), 1e-14);
  EXPECT_LT((shifted.cam_from_world.rotation - c.cam_from_world.rotation).norm(), 1e-15);
  const auto rotated = step(ParameterLayout::rotation + 2);
  EXPECT_LT((rotated.centre_in_world() - c.centre_in_world()).norm(), 1e-14);
}

TEST(StepBetween, IsTheInverseOfMoved) {
  for (const auto kind : {CameraKind::pinhole, CameraKind::lateral_effect}) {
    const auto c = imperfect_camera(kind, DetectorKind::generic, 2);
    Random random(31, 1);
    Eigen::VectorXd step(ParameterLayout(c).count);
    for (double& v : step) v = 0.01 * random.gaussian();
    EXPECT_LT((step_between(c, moved(c, step)) - step).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(step_between(c, c).segment(3, step.size() - 3).norm(), 0.0);
  }
}

TEST(WithWarpDegree, ExtendingTheWarpChangesNoImage) {
  const auto c = imperfect_camera(CameraKind::lateral_effect, DetectorKind::tetra_lateral, 2);
  const auto more = with_warp_degree(c, 10);
  EXPECT_EQ(more.detector.warp_x.size(), 63U);
  EXPECT_LT((project(more, {0.2, 0.1, 0.1}).image - project(c, {0.2, 0.1, 0.1}).image).norm(), 1e-15);
  EXPECT_EQ(with_warp_degree(more, 6).detector.warp_y, c.detector.warp_y);
  EXPECT_THROW((void)with_warp_degree(c, 16), std::logic_error);
  EXPECT_THROW((void)moved(c, Eigen::VectorXd::Zero(3)), std::logic_error);
}

}  // namespace
}  // namespace kinemark::camera
