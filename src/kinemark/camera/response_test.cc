// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/response.h"

#include <gtest/gtest.h>

#include "kinemark/camera/shares.h"
#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

using data::CameraKind;
using data::DetectorKind;
using data::ParameterLayout;

TEST(Respond, APerfectCameraGivesTheSheetsShares) {
  data::Camera c;
  c.focal = 2.0;
  const auto response = respond(c, {0.3, -0.1, 2.0});
  EXPECT_LT((response.spot - Eigen::Vector2d(0.3, -0.1)).norm(), 1e-15);
  EXPECT_LT((response.phi - tetra_lateral_shares(0.3, -0.1).share).norm(), 1e-15);
  EXPECT_TRUE(response.on_sheet && response.in_front);
}

TEST(Respond, CrosstalkComesBeforeGain) {
  data::Camera c;
  c.detector.crosstalk(0, 3) = 0.02;
  c.detector.gain << 1.0, 1.0, 1.0, 2.0;
  const auto h = tetra_lateral_shares(0.0, 0.0).share;
  const auto phi = respond_at(c.detector, {0.0, 0.0}).phi;
  EXPECT_NEAR(phi[3], 2.0 * (h[3] + 0.02 * h[0]), 1e-15);
  EXPECT_NEAR(phi[0], h[0], 1e-15);
}

TEST(Respond, DerivativesMatchDifferencesForEveryKind) {
  Random random(21, 1);
  for (const auto kind : {DetectorKind::tetra_lateral, DetectorKind::duo_lateral, DetectorKind::pin_cushion,
                          DetectorKind::generic}) {
    const auto c = imperfect_camera(CameraKind::lateral_effect, kind, 8);
    const ParameterLayout layout(c);
    for (int i = 0; i < 4; ++i) {
      const auto x = some_point(random);
      Eigen::Matrix<double, 4, Eigen::Dynamic> by_parameters(4, layout.count);
      const auto response = respond(c, x, by_parameters);
      EXPECT_EQ(response.phi, respond(c, x).phi);
      const auto by_point =
          differences([&c](const Eigen::VectorXd& p) { return respond(c, p).phi; }, x, 5e-4);
      EXPECT_LT((response.d_point - by_point).norm(), 1e-7);
      const auto slow =
          differences([&](const Eigen::VectorXd& step) { return respond(moved(c, step), x).phi; },
                      Eigen::VectorXd::Zero(layout.count), 5e-4);
      EXPECT_LT((by_parameters - slow).cwiseAbs().maxCoeff(), 1e-7) << to_string(kind);
      EXPECT_EQ(by_parameters.middleCols<4>(layout.offset).norm(), 0.0);
    }
  }
}

TEST(Respond, RefusesPinholeCamerasAndWrongWidths) {
  const auto pinhole = imperfect_camera(CameraKind::pinhole, DetectorKind::tetra_lateral, 8);
  EXPECT_THROW((void)respond(pinhole, {0, 0, 0}), std::logic_error);
  const auto c = imperfect_camera(CameraKind::lateral_effect, DetectorKind::tetra_lateral, 8);
  Eigen::Matrix<double, 4, Eigen::Dynamic> wrong(4, 15);
  EXPECT_THROW((void)respond(c, {0, 0, 0}, wrong), std::logic_error);
}

}  // namespace
}  // namespace kinemark::camera
