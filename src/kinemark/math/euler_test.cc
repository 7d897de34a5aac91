// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/euler.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

Vector3d random_vector(Random& random, double scale) {
  return {scale * random.uniform(-1, 1), scale * random.uniform(-1, 1), scale * random.uniform(-1, 1)};
}

TEST(BodyXyz, RoundTripsAwayFromTheSingularity) {
  Random random(1, 0);
  for (int i = 0; i < 500; ++i) {
    Vector3d t = random_vector(random, 3.1);
    t.y() *= 0.49;
    EXPECT_LT((to_body_xyz(from_body_xyz(t)) - t).norm(), 1e-12) << t.transpose();
  }
}

TEST(BodyXyz, AtTheSingularityTheRotationStillRoundTrips) {
  for (const double b : {std::numbers::pi / 2, -std::numbers::pi / 2}) {
    const Matrix3d R = from_body_xyz({0.3, b, -0.8});
    EXPECT_LT((from_body_xyz(to_body_xyz(R)) - R).norm(), 1e-12);
  }
}

TEST(BodyXyz, CloseToTheSingularityNothingIsLost) {
  for (const double distance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14})
    for (const double sign : {1.0, -1.0}) {
      const Matrix3d R = from_body_xyz({0.3, sign * (std::numbers::pi / 2 - distance), -0.8});
      EXPECT_LT((from_body_xyz(to_body_xyz(R)) - R).norm(), 2e-15) << distance;
    }
}

TEST(AnglesAbout, RecoversAnglesForEveryOrderAndHandedness) {
  Random random(2, 0);
  const Vector3d e[3] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (const auto& order : orders) {
    for (const double sign : {1.0, -1.0}) {
      Matrix3d axes;
      axes << e[order[0]], sign * e[order[1]], e[order[2]];
      for (int i = 0; i < 100; ++i) {
        const Vector3d t = random_vector(random, 6.0);  // beyond a turn: continuity picks the branch
        const Matrix3d R =
            axis_angle(axes.col(0), t[0]) * axis_angle(axes.col(1), t[1]) * axis_angle(axes.col(2), t[2]);
        const Vector3d found = to_angles_about(axes, R, t + random_vector(random, 0.1));
        EXPECT_LT((found - t).norm(), 1e-9) << t.transpose() << " / " << found.transpose();
      }
    }
  }
}

TEST(AnglesAbout, AtNinetyDegreesKeepsTheFirstAngleAndTheRotation) {
  Matrix3d axes;
  axes << Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY();
  for (const double b : {std::numbers::pi / 2, -std::numbers::pi / 2}) {
    const Vector3d t(0.7, b, -0.4);
    const Matrix3d R =
        axis_angle(axes.col(0), t[0]) * axis_angle(axes.col(1), t[1]) * axis_angle(axes.col(2), t[2]);
    const Vector3d u = to_angles_about(axes, R, Vector3d(0.2, b, 0.0));
    EXPECT_EQ(u[0], 0.2);
    const Matrix3d S =
        axis_angle(axes.col(0), u[0]) * axis_angle(axes.col(1), u[1]) * axis_angle(axes.col(2), u[2]);
    EXPECT_LT((R - S).norm(), 1e-9);
  }
}

TEST(So3, ExpTurnsByTheVectorsLengthAboutIt) {
  Random random(1, 1);
  for (const double size : {0.0, 1e-9, 1e-3, 0.7, 3.0, 7.0}) {
    const Vector3d axis = random_vector(random, 1.0).normalized();
    EXPECT_LT((exp_so3(size * axis) - axis_angle(axis, size)).norm(), 1e-12) << size;
  }
}

TEST(So3, LogIsTheInverseOfExp) {
  Random random(3, 0);
  for (const double scale : {1e-9, 1e-3, 1.0, 1.8}) {
    for (int i = 0; i < 50; ++i) {
      const Vector3d w = random_vector(random, scale);
      EXPECT_LT((log_so3(exp_so3(w)) - w).norm(), 1e-12 + 1e-9 * scale);
    }
  }
  EXPECT_EQ(exp_so3(Vector3d::Zero()), Matrix3d::Identity());
}

}  // namespace
}  // namespace kinemark::math
