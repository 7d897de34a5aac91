// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/projection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

using data::CameraKind;
using data::DetectorKind;
using data::ParameterLayout;

TEST(Project, IdealCameraByHand) {
  data::Camera c;
  c.name = "ideal";
  c.kind = CameraKind::pinhole;
  c.focal = 1000.0;
  c.principal_point = {640.0, 360.0};
  const auto seen = project(c, {0.2, -0.1, 2.0});
  EXPECT_EQ(seen.image, Eigen::Vector2d(740.0, 310.0));
  EXPECT_TRUE(seen.in_front && seen.on_sheet);
  EXPECT_FALSE(project(c, {0.2, -0.1, -2.0}).in_front);
}

TEST(Project, WarpMovesTheSpotOfALateralCamera) {
  data::Camera c;
  c.focal = 1.0;
  c = with_warp_degree(c, 2);
  c.detector.warp_x = {0.1, 0.0, 0.0};  // x^2
  c.detector.warp_y = {0.0, 0.2, 0.3};  // x y, y^2
  const auto seen = project(c, {0.5, 0.25, 1.0});
  EXPECT_NEAR(seen.image.x(), 0.5 + 0.1 * 0.25, 1e-16);
  EXPECT_NEAR(seen.image.y(), 0.25 + 0.2 * 0.125 + 0.3 * 0.0625, 1e-16);
  EXPECT_FALSE(project(c, {0.99, 0.0, 1.0}).on_sheet);
}

TEST(Project, DerivativesMatchDifferences) {
  Random random(11, 1);
  for (const auto kind : {CameraKind::pinhole, CameraKind::lateral_effect}) {
    const auto c = imperfect_camera(kind, DetectorKind::tetra_lateral, 4);
    const double unit = kind == CameraKind::pinhole ? c.focal : 1.0;
    const ParameterLayout layout(c);
    for (int i = 0; i < 5; ++i) {
      const auto x = some_point(random);
      Eigen::Matrix<double, 2, Eigen::Dynamic> by_parameters(2, layout.crosstalk);
      const auto seen = project(c, x, by_parameters);
      EXPECT_EQ(seen.image, project(c, x).image);
      const auto by_point =
          differences([&c](const Eigen::VectorXd& p) { return project(c, p).image; }, x, 1e-3);
      EXPECT_LT((seen.d_point - by_point).norm(), 1e-8 * unit);
      const auto slow =
          differences([&](const Eigen::VectorXd& step) { return project(moved(c, step), x).image; },
                      Eigen::VectorXd::Zero(layout.count), 1e-3);
      EXPECT_LT((by_parameters - slow.leftCols(layout.crosstalk)).norm(), 1e-7 * unit) << i;
    }
  }
}

TEST(Project, RefusesAJacobianOfTheWrongWidth) {
  const auto c = imperfect_camera(CameraKind::pinhole, DetectorKind::tetra_lateral, 4);
  Eigen::Matrix<double, 2, Eigen::Dynamic> wrong(2, 14);
  EXPECT_THROW((void)project(c, {0, 0, 0}, wrong), std::logic_error);
}

TEST(Unproject, TheRayPassesThroughThePoint) {
  Random random(12, 1);
  for (const auto kind : {CameraKind::pinhole, CameraKind::lateral_effect}) {
    const auto c = imperfect_camera(kind, DetectorKind::tetra_lateral, 6);
    for (int i = 0; i < 50; ++i) {
      const auto x = some_point(random);
      const auto ray = unproject(c, project(c, x).image);
      ASSERT_TRUE(ray);
      EXPECT_LT((x - ray->origin_in_world).cross(ray->direction_in_world).norm(), 1e-12);
      EXPECT_GT((x - ray->origin_in_world).dot(ray->direction_in_world), 0.0);
      EXPECT_NEAR(ray->direction_in_world.norm(), 1.0, 1e-15);
    }
  }
}

TEST(Unproject, SaysSoWhereThereIsNoRay) {
  auto c = imperfect_camera(CameraKind::lateral_effect, DetectorKind::tetra_lateral, 6);
  EXPECT_FALSE(unproject(c, {std::nan(""), 0.0}));
  c = with_warp_degree(c, 2);
  c.detector.warp_x = {-1.0, 0.0, 0.0};  // x - x^2 stays below a quarter
  c.detector.warp_y = {0.0, 0.0, 0.0};
  EXPECT_FALSE(unproject(c, {0.6, 0.0}));
}

}  // namespace
}  // namespace kinemark::camera
