// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/far_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

Eigen::Matrix3d random_rotation(Random& random) {
  return Eigen::Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
      .normalized()
      .toRotationMatrix();
}

TEST(FarPoints, DistancesOfCornersAreThoseOfRotationsAndOfOrigins) {
  Random random(3, 1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = random_rotation(random), S = random_rotation(random);
    const Eigen::Vector3d p(random.gaussian(), random.gaussian(), random.gaussian()), q(0.3, -0.2, 1.0);
    const auto corners = far_corners();
    const double squares = ((R * corners).colwise() + p - ((S * corners).colwise() + q)).squaredNorm();
    EXPECT_NEAR(squares, kFar_m * kFar_m * (R - S).squaredNorm() + kCorners * (p - q).squaredNorm(),
                1e-9 * squares);
  }
}

TEST(FarPoints, TheirWeightIsThatOfTheAngle) {
  // A small angle e costs e^2 / s^2 beside (distance / noise)^2 of a marker.
  const double s = 0.03, noise = 2e-3, e = 1e-4;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(e, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const double cost = far_weight(noise * noise, s * s) * (R * far_corners() - far_corners()).squaredNorm();
  EXPECT_NEAR(cost / (noise * noise), e * e / (s * s), 1e-6 * e * e / (s * s));
}

TEST(FarPoints, StandBehindTheMarkersOfModelAndRecording) {
  const auto description = testing_body::description();
  const auto with = add_far_points(description, {4, 0});
  ASSERT_EQ(with.markers.size(), description.markers.size() + 2 * kCorners);
  EXPECT_TRUE(with.validate());
  EXPECT_EQ(with.markers[description.markers.size()].body_idx, 4);
  EXPECT_EQ(with.markers.back().body_idx, 0);

  const auto model = model::Model::compile(description).value();
  const auto markers = testing_body::record(model, 2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d missing = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d origin(0.1, 0.2, 0.3);
  const auto points =
      add_far_points(markers, {turn, missing, turn, turn}, {origin, origin, origin, Eigen::Vector3d::Zero()});
  ASSERT_TRUE(points.validate()) << points.validate().error().message;
  const auto M = markers.markers();
  EXPECT_EQ(points.markers(), M + 8);
  EXPECT_EQ(points.x(1, 3), markers.x(1, 3));
  EXPECT_TRUE(points.present(0, M));
  EXPECT_FALSE(points.present(0, M + 4));
  EXPECT_TRUE(points.present(1, M + 4));
  EXPECT_LT((points.x(0, M + 1) - (origin + turn * far_corners().col(1))).norm(), 1e-12);
  EXPECT_LT((points.x(1, M + 7) - turn * far_corners().col(3)).norm(), 1e-12);
}

}  // namespace
}  // namespace kinemark::motion::internal
