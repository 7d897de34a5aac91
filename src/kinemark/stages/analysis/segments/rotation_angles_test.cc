// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/rotation_angles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"

namespace kinemark::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kHalf = 0.5 * std::numbers::pi;

Matrix3d product(const AngleSequence& s, const Vector3d& a) {
  Matrix3d out = Matrix3d::Identity();
  for (int k = 0; k < 3; ++k)
    out *= Eigen::AngleAxisd(a[k], Vector3d::Unit(s[static_cast<std::size_t>(k)])).toRotationMatrix();
  return out;
}

TEST(SequenceAngles, AreThoseOfTheProductForEverySequence) {
  Random random(11, 1);
  for (int first = 0; first < 3; ++first)
    for (int second = 0; second < 3; ++second)
      for (int third = 0; third < 3; ++third) {
        if (second == first || third == second) continue;
        const AngleSequence s{first, second, third};
        for (int n = 0; n < 50; ++n) {
          Vector3d a(random.uniform(-3.1, 3.1), 0.0, random.uniform(-3.1, 3.1));
          a[1] = third == first ? random.uniform(0.01, 3.13) : random.uniform(-1.56, 1.56);
          EXPECT_LT((sequence_angles(product(s, a), s) - a).cwiseAbs().maxCoeff(), 1e-9);
        }
      }
}

TEST(SequenceAngles, HaveNoOuterAnglesAtGimbalLock) {
  for (const double second : {kHalf, -kHalf}) {
    const auto a = sequence_angles(product({1, 0, 2}, {0.3, second, 0.2}), {1, 0, 2});
    EXPECT_TRUE(std::isnan(a[0]) && std::isnan(a[2]));
    EXPECT_NEAR(a[1], second, 1e-7);
  }
  const auto euler = sequence_angles(product({1, 0, 1}, {0.3, 0.0, 0.2}), {1, 0, 1});
  EXPECT_TRUE(std::isnan(euler[0]) && std::isnan(euler[2]));
  EXPECT_NEAR(euler[1], 0.0, 1e-7);
  EXPECT_TRUE(std::isnan(sequence_angles(Matrix3d::Constant(std::nan("")), {1, 0, 2})[1]));
}

TEST(SequenceAngles, KnowHowFarLockIs) {
  EXPECT_NEAR(distance_from_lock(kHalf - 0.1, {1, 0, 2}), 0.1, 1e-12);
  EXPECT_NEAR(distance_from_lock(0.1, {1, 0, 1}), 0.1, 1e-12);
  EXPECT_NEAR(distance_from_lock(std::numbers::pi - 0.1, {1, 0, 1}), 0.1, 1e-12);
}

TEST(SequenceAngles, AreParsed) {
  EXPECT_EQ(parse_sequence("YxZ").value(), (AngleSequence{1, 0, 2}));
  EXPECT_EQ(parse_sequence("yxy").value(), (AngleSequence{1, 0, 1}));
  for (const char* text : {"", "xx", "xxy", "xyw", "xyzx"})
    EXPECT_THAT(parse_sequence(text).error().message, ::testing::HasSubstr("no sequence of axes")) << text;
}

TEST(HelicalAxis, IsThatOfTheScrew) {
  Random random(12, 1);
  for (int n = 0; n < 200; ++n) {
    const Vector3d axis = Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
    const double angle = random.uniform(0.01, 3.1), along = random.uniform(-0.3, 0.3);
    const Vector3d point = Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    const Matrix3d r = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const auto found = helical_axis({r, point - r * point + along * axis});
    EXPECT_NEAR(found.angle_rad, angle, 1e-9);
    EXPECT_LT((found.direction - axis).norm(), 1e-9);
    EXPECT_NEAR(found.translation_m, along, 1e-9);
    EXPECT_LT((found.point - (point - point.dot(axis) * axis)).norm(), 1e-9);
  }
}

TEST(HelicalAxis, OfATranslationHasNoDirection) {
  const auto found = helical_axis({Matrix3d::Identity(), {0.3, 0.0, 0.4}});
  EXPECT_EQ(found.angle_rad, 0.0);
  EXPECT_DOUBLE_EQ(found.translation_m, 0.5);
  EXPECT_TRUE(found.direction.hasNaN() && found.point.hasNaN());
}

}  // namespace
}  // namespace kinemark::analysis
